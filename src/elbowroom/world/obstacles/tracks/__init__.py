"""Obstacles on tracks: where they are, and what they sweep."""
