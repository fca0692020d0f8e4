"""Runs as recordings, and recordings run again."""
