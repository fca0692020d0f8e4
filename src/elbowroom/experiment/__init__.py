"""How good: crossing trials with a scripted user."""
