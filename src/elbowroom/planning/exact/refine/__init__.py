"""More postures, sampled only where the search is blocked."""
