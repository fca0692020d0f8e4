"""How legs, hips and trunk walk: the cycle, feet that stand, and how a body lives."""
