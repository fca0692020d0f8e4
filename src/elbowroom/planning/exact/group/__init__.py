"""One group's problem along a root path: its node costs and its search."""
