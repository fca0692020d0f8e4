"""Poses by the Virtual Motion Capture protocol."""
