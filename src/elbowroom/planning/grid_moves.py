"""The moves from a cell of a grid to others, by which ways over it are searched: to sixteen directions."""

import numpy as np

STRAIGHT = 8  # of the moves that lead to a neighbour; the others pass between two
MOVES = np.array(
    [
        *([1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]),
        *([2, 1], [2, -1], [-2, 1], [-2, -1], [1, 2], [1, -2], [-1, 2], [-1, -2]),
    ]
)  # (16, 2) rows and columns
