"""Datasets of walks: drawn by a seed, judged by another library, in Parquet files that come out the same each time."""
