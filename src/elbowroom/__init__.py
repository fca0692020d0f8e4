"""You steer; your avatar finds the elbow room."""

__version__ = "0.1.0"
