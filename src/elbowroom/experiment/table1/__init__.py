"""The paper's experiment, Table 1: crossing trials for every scene, queue size and planner."""
