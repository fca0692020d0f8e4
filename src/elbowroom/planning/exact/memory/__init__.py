"""How results of earlier plans are found again."""
