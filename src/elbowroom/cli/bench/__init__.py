"""`elbowroom bench`: what the parts cost."""
