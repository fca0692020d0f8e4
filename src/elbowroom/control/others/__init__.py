"""Other avatars: what they are told, and how two pass each other."""
