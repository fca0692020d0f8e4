"""The collision body fitted to an avatar's surface, and how well it holds it."""
