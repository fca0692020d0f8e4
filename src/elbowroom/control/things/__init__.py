"""Obstacles that are pushed while somebody walks."""
