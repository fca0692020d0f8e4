"""The joint step: waist, left arm and right arm searched together."""
