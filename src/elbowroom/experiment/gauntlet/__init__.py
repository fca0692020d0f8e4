"""Gauntlets: random courses that are feasible by construction."""
