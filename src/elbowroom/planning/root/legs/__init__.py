"""Legs and pelvis, which cannot bend: where they go and how far they are free."""
