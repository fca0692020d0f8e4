"""A live session: one client's walk, its clock, its plans, and what it is told."""
