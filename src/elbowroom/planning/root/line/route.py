"""The detour: the cheapest route over a window of the walkable map, pulled tight.

The window lies along the line of travel: its first axis runs ahead, its middle column is the line itself. Dijkstra's
search (Numer. Math. 1, 1959) settles every free cell; the cell whose progress best repays its cost is the goal, so that
a wall without a detour gives a route that ends before it. Costs: metres walked, dearer beside the line and close to
obstacles.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.grid_moves import MOVES, STRAIGHT
from elbowroom.planning.heap import pop, push
from elbowroom.world.walkable import WalkableMap, interpolate_grid

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class RouteSettings:
    """What a route is worth."""

    progress: float = 2.5  # metres of walking that one metre ahead is worth
    aside: float = 0.25  # extra cost per metre walked, for each metre away from the line
    tight: float = 3.0  # extra cost per metre walked where there is no clearance beyond the margin
    roomy: float = 0.15  # metres of clearance beyond the margin that cost nothing extra


class Search(NamedTuple):
    """The settings of one search, in grid units where lengths are meant."""

    start_a: float
    start_l: float
    line: float  # column of the line of travel
    cell: float  # metres
    margin: float  # metres of clearance that a cell must have
    progress: float
    aside: float
    tight: float
    roomy: float


_EMPTY = plain(0)  # size of a heap
_ESCAPE = 0.4  # metres around the start where less clearance than the margin is accepted: one must be able to leave


def find_route(
    window: WalkableMap, start: tuple[float, float], line: float, margin: float, settings: RouteSettings
) -> Floats:
    """Corner points (m, 2), world x and z, of the route from `start`, given in metres ahead and left in the window.

    `line` is the distance of the line of travel from the window's first column. The route is a single point if the
    start has no path on.
    """
    cell = window.cell
    search = Search(
        start[0] / cell,
        start[1] / cell,
        line / cell,
        cell,
        margin,
        settings.progress,
        settings.aside,
        settings.tight,
        settings.roomy,
    )
    corners = _search(window.clearance, search) * cell
    sine, cosine = np.sin(window.heading), np.cos(window.heading)
    x = window.origin[0] + corners[:, 0] * sine + corners[:, 1] * cosine
    z = window.origin[1] + corners[:, 0] * cosine - corners[:, 1] * sine
    return np.stack([x, z], axis=1)


def route_points(route: Floats, spacing: float) -> tuple[Floats, Floats]:
    """Points (N, 2) on a route at most `spacing` apart, and their distances (N,) along it."""
    ends = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route, axis=0).T))])
    along = np.linspace(0.0, ends[-1], max(2, math.ceil(ends[-1] / spacing) + 1))
    points = np.stack([np.interp(along, ends, route[:, 0]), np.interp(along, ends, route[:, 1])], axis=1)
    return points, along


def shortened_route(route: Floats, length: float) -> Floats:
    """The first `length` metres of a route."""
    points, along = route_points(route, 0.04)
    keep = max(1, int(np.searchsorted(along, length, side="right")))
    return points[:keep] if keep > 1 else points[[0, 0]]


@exact_kernel
def _search(grid: Floats32, search: Search) -> Floats:
    """The tightened route in grid coordinates."""
    first = (
        min(max(round(search.start_a), 0), grid.shape[0] - 1),
        min(max(round(search.start_l), 0), grid.shape[1] - 1),
    )
    cost, parents = _settle(grid, search, first[0] * grid.shape[1] + first[1])
    best, goal = np.inf, first[0] * grid.shape[1] + first[1]
    for node in range(cost.shape[0]):
        worth = cost[node] - search.progress * search.cell * (node // grid.shape[1] - search.start_a)
        if worth < best - 1e-9:
            best, goal = worth, node
    return _pulled_tight(grid, search, _trace(parents, goal, grid.shape[1], search))


@inner_exact_kernel
def _needed(search: Search, here: float, a: float, b: float) -> float:
    """Clearance that is asked for at (a, b); `here` is the start's own."""
    if here >= search.margin:
        return search.margin
    distance = np.sqrt((a - search.start_a) ** 2 + (b - search.start_l) ** 2) * search.cell
    return min(here - 1e-3, search.margin) if distance < _ESCAPE else search.margin


@helper
def _settle(grid: Floats32, search: Search, first: int) -> tuple[Floats, Indices]:
    """Cost and parent of every cell (row by row); unreached cells cost infinity."""
    rows, columns = grid.shape
    cost, parents = np.empty(rows * columns), np.empty(rows * columns, np.int64)
    done = np.empty(rows * columns, np.bool_)
    cost[:], parents[:], done[:] = np.inf, -1, False
    keys, nodes = np.empty(rows * columns * 16 + 1), np.empty(rows * columns * 16 + 1, np.int64)
    here = float(grid[first // columns, first % columns])
    size = push(keys, nodes, _EMPTY, 0.0, first)
    cost[first] = 0.0
    while size > 0:
        node = nodes[0]
        size = pop(keys, nodes, size)
        if done[node]:
            continue
        done[node] = True
        i, j = node // columns, node % columns
        for m in range(MOVES.shape[0]):
            a, b = i + MOVES[m, 0], j + MOVES[m, 1]
            if not (0 <= a < rows and 0 <= b < columns):
                continue
            clear = float(grid[a, b])
            if done[a * columns + b] or clear < _needed(search, here, a, b):
                continue
            if m >= STRAIGHT:
                between = interpolate_grid(grid, i + 0.5 * MOVES[m, 0], j + 0.5 * MOVES[m, 1])
                if between < _needed(search, here, a, b):
                    continue
            length = np.sqrt(MOVES[m, 0] * MOVES[m, 0] + MOVES[m, 1] * MOVES[m, 1]) * search.cell
            aside = search.aside * abs(b - search.line) * search.cell
            narrow = search.tight * min(max(1.0 - (clear - search.margin) / search.roomy, 0.0), 1.0)
            total = cost[node] + length * (1.0 + aside + narrow)
            if total < cost[a * columns + b] - 1e-12:
                cost[a * columns + b], parents[a * columns + b] = total, node
                size = push(keys, nodes, size, total, a * columns + b)
    return cost, parents


@helper
def _trace(parents: Indices, goal: int, columns: int, search: Search) -> Floats:
    """The cells from the start to the goal; the first is the exact start."""
    count, node = 1, goal
    while parents[node] >= 0:
        node = parents[node]
        count += 1
    out = np.empty((count, 2))
    node = goal
    for k in range(count - 1, -1, -1):
        out[k, 0], out[k, 1] = node // columns, node % columns
        node = parents[node]
    out[0, 0], out[0, 1] = search.start_a, search.start_l
    return out


@helper
def _pulled_tight(grid: Floats32, search: Search, cells: Floats) -> Floats:
    """Only the corners that are needed: from each, the farthest cell in sight is the next."""
    here = float(interpolate_grid(grid, search.start_a, search.start_l))
    corners = np.empty(cells.shape)
    corners[0, 0], corners[0, 1] = cells[0, 0], cells[0, 1]
    count, at, last = 1, 0, cells.shape[0] - 1
    while at < last:
        reached = last
        while reached > at + 1 and not _in_sight(grid, search, here, cells[at], cells[reached]):
            reached -= 1
        corners[count, 0], corners[count, 1] = cells[reached, 0], cells[reached, 1]
        count += 1
        at = reached
    return corners[:count].copy()


@helper
def _in_sight(grid: Floats32, search: Search, here: float, a: Floats, b: Floats) -> bool:
    """Whether the straight route between two points keeps the clearance."""
    steps = int(np.ceil(2.0 * max(abs(b[0] - a[0]), abs(b[1] - a[1]))))
    for k in range(steps + 1):
        t = k / max(steps, 1)
        x, y = a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])
        if interpolate_grid(grid, x, y) < _needed(search, here, x, y):
            return False
    return True
