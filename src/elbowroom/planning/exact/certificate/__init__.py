"""Why there is no path: the fewest obstacles that close it."""
