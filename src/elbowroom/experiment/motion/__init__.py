"""How a walk looks: scripted walks in the real controller, measured as a gait laboratory would."""
