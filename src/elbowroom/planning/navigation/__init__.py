"""The way to a place: over a map of the room that there is, for the controller to walk."""
