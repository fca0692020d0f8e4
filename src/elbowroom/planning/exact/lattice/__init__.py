"""The time lattice of one group: its nodes, what edges cost, and the cheapest path through it."""
