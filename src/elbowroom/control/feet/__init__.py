"""How feet stand and step under a motion that is played, as it is shown."""
