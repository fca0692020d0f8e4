"""Where legs can stand: the clearance of a vertical capsule over a grid of places on the ground."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.jit import kernel
from elbowroom.world.obstacles.clearance import lower_clearance
from elbowroom.world.obstacles.extents import reach_along
from elbowroom.world.obstacles.from_above import place_of
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import how_many, row_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

MAX_CELLS = 250_000
FARTHEST = 1.0  # metres: greater clearance is not told apart on a map of the whole ground


class StanceCapsule(NamedTuple):
    """A vertical capsule that stands for legs and pelvis, metres."""

    radius: float
    low: float  # height of the axis's lower end
    high: float  # and of its upper end


@dataclass(frozen=True, eq=False)
class WalkableMap:
    """Clearance of a vertical capsule at the points of a grid; negative where it would touch."""

    origin: tuple[float, float]  # x, z of point (0, 0), metres
    heading: float  # direction of the grid's first axis on the ground, radians; the second points to its left
    cell: float  # distance of neighbouring points, metres
    clearance: Floats32  # (ahead, left), metres; greater clearance than `farthest` is not told apart

    def at(self, x: float, z: float) -> float:
        """Clearance at a place, interpolated between the four points around it; minus infinity outside."""
        sine, cosine = np.sin(self.heading), np.cos(self.heading)
        dx, dz = x - self.origin[0], z - self.origin[1]
        ahead, left = (dx * sine + dz * cosine) / self.cell, (dx * cosine - dz * sine) / self.cell
        return float(interpolate_grid(self.clearance, ahead, left))


def walkable_map(scene: Scene, radius: float, low: float, high: float, cell: float = 0.1) -> WalkableMap:
    """Clearance over the scene's ground of a vertical capsule whose axis reaches from height `low` to `high`.

    Metres. `cell` grows where the ground would need more than `MAX_CELLS` points.
    """
    width, depth = scene.ground_size
    cell = max(cell, float(np.sqrt(width * depth / MAX_CELLS)) * 1.01)
    shape = (int(depth / cell) + 1, int(width / cell) + 1)
    origin = (scene.ground_center[0] - 0.5 * width, scene.ground_center[1] - 0.5 * depth)
    return walkable_window(scene.obstacles.standing, StanceCapsule(radius, low, high), origin, 0.0, shape, cell)


def walkable_window(
    near: Nearby,
    stance: StanceCapsule,
    origin: tuple[float, float],
    heading: float,
    shape: tuple[int, int],
    cell: float,
    farthest: float = FARTHEST,
    heights: tuple[Floats, Floats] | None = None,
) -> WalkableMap:
    """Clearance over a grid that starts at `origin` and runs along `heading`, of the stance.

    It stands at `heights`, those (ahead, left) of its lower end and of its upper one, or at height 0. Clearance above
    `farthest` metres is given as `farthest`: the less, the sooner it is done.
    """
    out = np.full(shape, farthest, np.float32)
    place = np.array([*origin, np.sin(heading), np.cos(heading), cell, farthest])
    stands = np.zeros((2, *shape), np.float32) if heights is None else np.stack(heights).astype(np.float32)
    _fill_window(near, np.array(stance, np.float32), place, stands, out)
    return WalkableMap(origin, heading, cell, out)


def stance_segments(stance: StanceCapsule, x: ArrayLike, z: ArrayLike) -> Floats32:
    """The capsule's axis (1, 6, N) at places `x`, `z` (N,)."""
    across, along = np.asarray(x, np.float32), np.asarray(z, np.float32)
    low, high = np.full_like(across, stance.low), np.full_like(across, stance.high)
    return np.stack([across, low, along, across, high, along])[None]


@kernel
def _fill_window(near: Nearby, stance: Floats32, place: Floats, heights: Floats32, out: Floats32) -> None:
    """Lower every point within reach of an obstacle; the points around one are one batch of the clearance kernel."""
    sine, cosine, cell, farthest = place[2], place[3], place[4], place[5]
    ahead, left = out.shape
    for b in range(how_many(near)):
        x, z = place_of(near, b)
        dx, dz = x - place[0], z - place[1]
        center_a, center_l = (dx * sine + dz * cosine) / cell, (dx * cosine - dz * sine) / cell
        away = stance[0] + farthest
        reach_a = (reach_along(near, b, (sine, 0.0, cosine)) + away) / cell + 1.0
        reach_l = (reach_along(near, b, (cosine, 0.0, -sine)) + away) / cell + 1.0
        first_a, last_a = max(0, int(center_a - reach_a)), min(ahead, int(center_a + reach_a) + 1)
        first_l, last_l = max(0, int(center_l - reach_l)), min(left, int(center_l + reach_l) + 1)
        rows, columns = last_a - first_a, last_l - first_l
        if rows <= 0 or columns <= 0:
            continue
        segments = np.empty((1, 6, rows * columns), np.float32)
        least = np.empty(rows * columns, np.float32)
        for i in range(rows):
            for j in range(columns):
                k, along, aside = i * columns + j, (first_a + i) * cell, (first_l + j) * cell
                x = place[0] + along * sine + aside * cosine
                z = place[1] + along * cosine - aside * sine
                low, high = heights[0, first_a + i, first_l + j], heights[1, first_a + i, first_l + j]
                segments[0, 0, k], segments[0, 1, k], segments[0, 2, k] = x, low + stance[1], z
                segments[0, 3, k], segments[0, 4, k], segments[0, 5, k] = x, high + stance[2], z
                least[k] = out[first_a + i, first_l + j]
        lower_clearance(segments, stance[:1], row_of(near, b), least)
        for i in range(rows):
            for j in range(columns):
                out[first_a + i, first_l + j] = least[i * columns + j]


@kernel
def interpolate_grid(grid: Floats32, a: float, b: float) -> float:
    """The value at grid coordinates (a, b), bilinear; minus infinity outside."""
    if not (0.0 <= a <= grid.shape[0] - 1 and 0.0 <= b <= grid.shape[1] - 1):
        return -np.inf
    i, j = min(int(a), grid.shape[0] - 2), min(int(b), grid.shape[1] - 2)
    u, v = a - i, b - j
    low = grid[i, j] * (1.0 - v) + grid[i, j + 1] * v
    high = grid[i + 1, j] * (1.0 - v) + grid[i + 1, j + 1] * v
    value: float = low * (1.0 - u) + high * u
    return value
