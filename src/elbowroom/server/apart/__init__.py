"""Work on what comes from outside, in processes of their own: bounded in memory, time and size, and ended at once."""
