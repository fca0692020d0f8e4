"""Messages and poses as they go over the wire."""
