"""Models of places: read, measured, and made into scenes."""
