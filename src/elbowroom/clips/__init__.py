"""What was recorded: motion files, the bodies in them, and how they move ours."""
