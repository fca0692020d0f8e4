"""Along the line of travel: straight on, round what stands in it, or round the corners of a way."""
