"""Plans: who is asked for them, where and when they are made, and how they are rehearsed."""
