"""What stands in the way, and the only door to it: its shapes, where they are, and how far capsules are from them."""
