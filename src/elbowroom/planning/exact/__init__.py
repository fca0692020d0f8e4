"""The exact planner: each posture at each key time settled once, checked as playback shows it."""
