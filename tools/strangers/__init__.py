"""How other programs read what we export: `make strangers`."""
