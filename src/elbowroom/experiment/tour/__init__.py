"""Walks to places in a scene, one after the other."""
