"""Recordings as films: the page drawn in a headless browser, a picture at a time, and put into a file."""
