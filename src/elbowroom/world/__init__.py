"""Where: scenes, clearance kernels and the walkable map."""
