"""Clearance of nodes and edges, and the proof that a motion is free at every moment."""
