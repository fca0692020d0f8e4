"""An avatar's file becomes a humanoid: its bones, T-pose, size, and what may be done with it."""
