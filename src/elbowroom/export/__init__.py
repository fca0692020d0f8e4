"""What was shown, as files that other programs read."""
