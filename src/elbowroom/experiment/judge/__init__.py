"""The judge: whether a shown motion touches anything, by another library and by kinematics of its own."""
