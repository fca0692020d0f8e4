"""Benchmarks: what the kernels and the planners cost, beside what others need for the same."""
