"""What feet stand on: the level ground, and whatever is low and flat enough to be stepped onto."""
