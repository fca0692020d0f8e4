"""What is shown: a pose at a time, each proven free on the way from the last."""
