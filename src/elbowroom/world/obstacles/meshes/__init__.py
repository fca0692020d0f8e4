"""Meshes and hulls: cut, packed, filled, looked up."""
