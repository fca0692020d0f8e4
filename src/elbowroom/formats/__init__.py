"""Files in and out, as arrays: what a format says, not yet what it means for a body or a scene."""
