"""Who may come in, how fast, and with what."""
