"""Narrow places as people pass them: with room to both sides, arms close, shoulders turned, and slower."""
