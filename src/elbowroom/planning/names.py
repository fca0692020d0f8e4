"""The planners' names, where importing the planners themselves would take too long."""

FIGURE6 = "figure6"  # the paper's own search
EXACT = "exact"  # dynamic programming, checked as shown
PLANNER_NAMES = (EXACT, FIGURE6)
DEFAULT_PLANNER = EXACT
