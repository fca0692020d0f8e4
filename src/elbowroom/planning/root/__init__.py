"""The root's path f(t): from a command to a short path that is free for legs and pelvis."""
