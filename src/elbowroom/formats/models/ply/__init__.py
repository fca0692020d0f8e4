"""PLY files whose faces have more than three corners (G. Turk 1994, "The PLY Polygon File Format")."""
