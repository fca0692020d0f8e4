"""Squared distances of capsules' axes from each shape, sixteen at a time."""
