"""Floors above one another as one surface that is walked on: steps, stairs and ramps link them, edges end them.

The stages are Recast's (M. Mononen, recastnavigation): surfaces one can stand on over the cells of a grid, each linked
to its neighbour on the four sides if the step is no higher than a knee; what is nearer to an edge than a body is wide
is taken away; what hangs together is a region.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.world.places.columns import Columns
from elbowroom.world.places.floors import SLIM, standing_surfaces

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Links = NDArray[np.int32]
Flags = NDArray[np.bool_]

STEP = 0.4  # metres: the knee of an adult; higher is climbed, not walked
STOOPED = 1.3  # metres of headroom: with less a floor is nothing to walk on, however deep one bends
_SAME = 0.1  # metres: surfaces in a cell that are closer are one, the highest
_ENOUGH = 0.5  # m² of a region at the height of a floor: less is not the floor
_SIDES = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])


@dataclass(frozen=True, eq=False)
class Layers:
    """N surfaces to stand on, ordered by cell and then by height, and how they hang together."""

    columns: Columns
    cells: Ints  # (N,) ix * shape[1] + iz
    heights: Floats  # (N,) metres
    links: Links  # (N, 4) the neighbour towards +x, +z, -x, -z; -1 where there is an edge or something stands
    regions: Links  # (N,) of those where the middle of a slim body can be: its region from 0; -1 elsewhere

    def regions_at(self, height: float, least: float, within: float = _SAME) -> set[int]:
        """The regions that have at least so much area, m², about a height."""
        near = self.regions[(np.abs(self.heights - height) <= within) & (self.regions >= 0)]
        areas = np.bincount(near) * self.columns.cell**2
        return {int(region) for region in np.flatnonzero(areas >= least)}


def linked_floors(layers: Layers, heights: Sequence[float]) -> list[list[int]]:
    """For each floor at some height the numbers of those others that one walks to from it."""
    regions = [layers.regions_at(height, _ENOUGH) for height in heights]
    return [
        [other for other in range(len(heights)) if other != floor and regions[other] & regions[floor]]
        for floor in range(len(heights))
    ]


def layers_of(columns: Columns) -> Layers:
    """Link what one can stand on in a place."""
    stood = standing_surfaces(columns, STOOPED)
    cells, heights = columns.cells[stood], columns.low[stood]
    top = np.append((cells[1:] != cells[:-1]) | (heights[1:] - heights[:-1] > _SAME), True)[: len(cells)]
    cells, heights = cells[top], heights[top]
    starts = np.searchsorted(cells, np.arange(columns.shape[0] * columns.shape[1] + 1))
    links = link_surfaces(cells, heights, starts, columns.shape[0], columns.shape[1], STEP)
    inside = without_edges(links, max(round(SLIM / columns.cell), 1))
    return Layers(columns, cells, heights, links, _regions(links, inside))


@exact_kernel
def link_surfaces(cells: Ints, heights: Floats, starts: Ints, width: int, depth: int, step: float) -> Links:
    """The links (N, 4) of surfaces: to that in the neighbouring cell whose height is nearest, if a step leads there.

    `starts` (cells + 1,) are the first surfaces of the cells. Links lead both ways or not at all.
    """
    links = np.full((cells.shape[0], 4), -1, np.int32)
    for n in range(cells.shape[0]):
        ix, iz = cells[n] // depth, cells[n] % depth
        for side in range(4):
            jx, jz = ix + _SIDES[side, 0], iz + _SIDES[side, 1]
            if not (0 <= jx < width and 0 <= jz < depth):
                continue
            least = step
            for other in range(starts[jx * depth + jz], starts[jx * depth + jz + 1]):
                rise = abs(heights[other] - heights[n])
                if rise <= least:
                    least, links[n, side] = rise, other
    for n in range(cells.shape[0]):
        for side in range(4):
            other = links[n, side]
            if other >= 0 and links[other, (side + 2) % 4] != n:
                links[n, side] = -1
    return links


def without_edges(links: Links, rounds: int) -> Flags:
    """The surfaces (N,) that so many rounds leave: each takes away what has no neighbour at a side, or at a corner.

    Sides and corners take turns, so that what is left keeps about as far from an edge in all directions.
    """
    alive = np.ones(len(links), bool)
    for number in range(rounds):
        known = np.append(alive, False)  # -1 is nobody
        kept = alive & known[links].all(axis=1)
        if number % 2 == 1:
            padded = np.concatenate([links, np.full((1, 4), -1, np.int32)])
            for side in range(4):
                kept &= known[padded[links[:, side], (side + 1) % 4]]
        alive = kept
    return alive


def _regions(links: Links, inside: Flags) -> Links:
    """The regions (N,) of the surfaces that are inside, the largest first; -1 for all others."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components  # slow to import, and not needed on a plain

    found = np.full(len(links), -1, np.int32)
    if not inside.any():
        return found
    known = np.append(inside, False)
    joined = inside[:, None] & known[links]
    begins, ends = np.nonzero(joined)[0], links[joined]
    graph = coo_matrix((np.ones(len(begins), np.int8), (begins, ends)), shape=(len(links), len(links)))
    labels = connected_components(graph, directed=False)[1][inside]
    _, numbers, counts = np.unique(labels, return_inverse=True, return_counts=True)
    order = np.empty(len(counts), np.int32)
    order[np.argsort(-counts, kind="stable")] = np.arange(len(counts), dtype=np.int32)
    found[inside] = order[numbers]
    return found
