"""A binary heap in two arrays, for searches that settle the cheapest node first (Williams, CACM 7, 1964)."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@exact_kernel
def push(keys: Floats, nodes: Indices, size: int, key: float, node: int) -> int:
    """Add to the binary heap; returns its new size."""
    at = size
    while at > 0 and keys[(at - 1) // 2] > key:
        keys[at], nodes[at] = keys[(at - 1) // 2], nodes[(at - 1) // 2]
        at = (at - 1) // 2
    keys[at], nodes[at] = key, node
    return size + 1


@exact_kernel
def pop(keys: Floats, nodes: Indices, size: int) -> int:
    """Remove the least entry of the binary heap; returns its new size."""
    size -= 1
    key, node = keys[size], nodes[size]
    at = 0
    while 2 * at + 1 < size:
        child = 2 * at + 1
        if child + 1 < size and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[at], nodes[at] = keys[child], nodes[child]
        at = child
    keys[at], nodes[at] = key, node
    return size
