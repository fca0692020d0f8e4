"""Two avatars who meet in a corridor: whether they get past each other."""
