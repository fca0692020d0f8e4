"""The order of attempts, from one group after the other to the extension of a plan that is still good."""
