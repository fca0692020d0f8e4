"""A picture of avatars in the same gestures, to see with one's own eyes that the same configuration looks the same."""
