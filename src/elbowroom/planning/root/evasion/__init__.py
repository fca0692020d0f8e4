"""Past what is narrow: grids of places and turns along a line, and the cheapest path through them."""
