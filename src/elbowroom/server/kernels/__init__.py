"""Compiled kernels: which there are, where they are kept, and how all are made before anybody waits."""
