"""The ground of a scene: made once, from what stands in it, by its shape and not by its name."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.jit import exact_kernel, helper
from elbowroom.world.ground.cells import CellGrid, CellParts, cell_by_cell, grid_over, part_in, parts_of
from elbowroom.world.ground.gaps import spans_over
from elbowroom.world.ground.ground import FIRM, PLAIN, RELIEF, SPANS, STEEPEST, STEP, Ground
from elbowroom.world.ground.kept_ground import kept_ground
from elbowroom.world.ground.whole_squares import is_whole
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Mesh
from elbowroom.world.obstacles.triangles import triangles_of
from elbowroom.world.places.floor_area import FloorArea

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

RISE = 0.005  # metres: what rises no higher from the plane is the plane
_SAME, _WHOLE = 2e-4, 0.9999  # metres, share of a cell: what is as high, and covered
_FLAT = 1e-9  # m²: a triangle that covers less of the ground is upright
_AT_ONCE = 4096  # triangles that are turned together, at least, where there are as many
_THRESHOLD = 0.2  # metres that a floor is taken to reach beyond its edge: what is there is no hole


class _Standing(NamedTuple):
    """What stands, as its surface."""

    triangles: Floats  # (T, 3, 3) about its own origin
    turn: Floats  # (4,)
    center: Floats  # (3,)
    open: bool  # it may be seen from both sides


def ground_of(obstacles: Obstacles, floor: FloorArea | None = None, step: float = STEP) -> Ground:
    """The ground of what stands on the plane at height 0, which is ground all over, or where a place has its `floor`.

    It is reached by steps of up to `step` metres. Plain where no surface lies within a step of the plane, or all of
    those rise from it by nothing, or lie under it.
    """
    triangles = level_triangles(obstacles)
    least, most = triangles[:, :, 1].min(axis=1, initial=np.inf), triangles[:, :, 1].max(axis=1, initial=-np.inf)
    within = (least <= step) & (most >= -step) & ((most > RISE) | (least < -RISE))
    within[within] &= (most[within] > RISE) | ~_covered(triangles[within], floor)
    if not within.any():
        return PLAIN
    return kept_ground(__file__, triangles, floor, step, lambda: _gridded(triangles, floor, step))


def walked_over(obstacles: Obstacles, floor: FloorArea | None) -> Obstacles:
    """What stands in a place with a `floor`: all of it is in the way where its ground is not plain, floors included.

    Feet are held above what they stand on there. Else what does not rise from the plane is not in the way.
    """
    return obstacles if floor is None or ground_of(obstacles, floor).plain else over_floors(obstacles)


def over_floors(obstacles: Obstacles) -> Obstacles:
    """What stands in a place whose floors are in the way like all else."""
    return replace(obstacles, ground=-np.inf)


def level_triangles(obstacles: Obstacles) -> Floats:
    """The triangles (T, 3, 3) of what stands that are no steeper than one walks, and face up where it is closed."""
    found, together, count = [np.empty((0, 3, 3))], list[_Standing](), 0
    for _, shape, center, turn in obstacles:
        together.append(_Standing(triangles_of(shape), turn, center, open=isinstance(shape, Mesh)))
        count += len(together[-1].triangles)
        if count >= _AT_ONCE:
            found.append(_level_of(together))
            together, count = [], 0
    return np.concatenate([*found, _level_of(together)] if together else found)


def _level_of(together: list[_Standing]) -> Floats:
    """The same of some of what stands, in its order."""
    each = [len(one.triangles) for one in together]
    turns, centers, opens = (
        np.repeat(np.array(told), each, axis=0)
        for told in ([one.turn for one in together], [one.center for one in together], [one.open for one in together])
    )
    about = np.concatenate([one.triangles for one in together])
    corners = quaternion.rotate(turns[:, None], about) + centers[:, None]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    up = np.where(opens, np.abs(normals[:, 1]), normals[:, 1])
    steep = np.cos(STEEPEST) * np.linalg.norm(normals, axis=1)
    level: Floats = corners[(up >= steep * (1.0 - 1e-9)) & (up > _FLAT)]
    return level


def _covered(triangles: Floats, floor: FloorArea | None) -> Bools:
    """Which of the triangles (T, 3, 3) have the plane over them wherever they are."""
    if floor is None:
        return np.ones(len(triangles), np.bool_)
    flat, last = triangles[:, :, [0, 2]], np.array(floor.there.shape) - 1
    low, high = (
        np.floor((edge - floor.origin) / floor.cell).astype(np.int64) for edge in (flat.min(axis=1), flat.max(axis=1))
    )
    gaps = np.zeros(last + 2, np.int64)  # holes in the floor before each of its squares, along both axes
    gaps[1:, 1:] = (~floor.there).cumsum(axis=0).cumsum(axis=1)
    (a, b), (c, d) = np.clip(low, 0, last).T, np.clip(high, 0, last).T + 1
    whole = gaps[c, d] - gaps[a, d] - gaps[c, b] + gaps[a, b] == 0
    covered: Bools = whole & np.all((low >= -1) & (high <= last + 1), axis=1)
    return covered


def _gridded(triangles: Floats, floor: FloorArea | None, step: float) -> Ground:
    grid, planes = grid_over(triangles, floor), planes_of(triangles)
    parts = parts_of(planes, grid)
    starts, members, bottoms, tops = cell_by_cell(parts, grid)
    level = np.ones(grid.cells, np.bool_) if floor is None else _floor_cells(floor, grid)
    none = (np.zeros(grid.cells + 1, np.int64), np.empty(0))
    firm = Ground(False, step, *grid, starts, members, bottoms, tops, planes, level, floor is None, *none)
    ground = _with_evens(firm)
    gaps = planes_of(spans_over(ground))
    return _spanned(ground, parts, gaps, grid) if len(gaps) else ground


def _spanned(ground: Ground, firm: CellParts, gaps: Floats, grid: CellGrid) -> Ground:
    """The same ground, of which the firm parts are given, with its gaps spanned by triangles (G, 10)."""
    gaps[:, SPANS] = 1.0
    spans = parts_of(gaps, grid, first=len(ground.triangles))
    both = CellParts(*(np.concatenate([one, other]) for one, other in zip(firm, spans, strict=True)))
    starts, members, bottoms, tops = cell_by_cell(both, grid)
    planes = np.concatenate([ground.triangles, gaps])
    return ground._replace(starts=starts, members=members, bottoms=bottoms, tops=tops, triangles=planes)


def _with_evens(ground: Ground) -> Ground:
    """The same ground with the even heights of its cells. What spans gaps is not even, and counts for nothing."""
    starts, evens = _evens(ground)
    return ground._replace(even_starts=starts, evens=evens)


def planes_of(triangles: Floats) -> Floats:
    """Triangles (T, 3, 3) as `Ground` has them, turned so that seen from above each corner has the next to its left.

    Columns (T, 10): x, z, height of a corner; x, z of the next two; grade along x and z; whether it spans a gap: none
    does.
    """
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    u, v = b - a, c - a
    area = u[:, 2] * v[:, 0] - u[:, 0] * v[:, 2]
    turned = area < 0.0
    u, v = np.where(turned[:, None], v, u), np.where(turned[:, None], u, v)
    area = np.abs(area)
    along_x = (u[:, 2] * v[:, 1] - v[:, 2] * u[:, 1]) / area
    along_z = (v[:, 0] * u[:, 1] - u[:, 0] * v[:, 1]) / area
    columns = [a[:, 0], a[:, 2], a[:, 1], *(a + u)[:, [0, 2]].T, *(a + v)[:, [0, 2]].T, along_x, along_z]
    return np.ascontiguousarray(np.stack([*columns, np.zeros(len(triangles))], axis=1))


@exact_kernel
def _evens(ground: Ground) -> tuple[Longs, Floats]:
    """Where the even heights of each cell begin (cells + 1,), and these (E,)."""
    planes, starts, members, deep, side = ground.triangles, ground.starts, ground.members, ground.shape[1], ground.cell
    begins, out = np.zeros(starts.shape[0], np.int64), np.empty(starts.shape[0])
    found, parts = 0, np.empty((1 + int((starts[1:] - starts[:-1]).max()), 3))
    for cell in range(starts.shape[0] - 1):
        corner, count = (ground.corner[0] + side * (cell // deep), ground.corner[1] + side * (cell % deep)), 0
        if ground.level[cell]:
            parts[0], count = (side * side, 0.0, 0.0), 1
        for m in range(starts[cell], starts[cell + 1]):
            if planes[members[m], SPANS] < FIRM:
                parts[count] = part_in(planes[members[m]], corner, side)
                count += parts[count, 0] > 0.0
        for k in range(count):
            if _is_even(parts[:count], k, side, ground.step) and is_whole(ground, corner, parts[k, 2], RELIEF):
                if found == out.shape[0]:
                    longer = np.empty(2 * found)
                    longer[:found] = out
                    out = longer
                out[found] = parts[k, 2]
                found += 1
        begins[cell + 1] = found
    return begins, out[:found].copy()


@helper
def _is_even(parts: Floats, k: int, side: float, step: float) -> bool:
    """Whether parts of surfaces (n, 3), area, lowest and highest point, fill a square just below the top of part `k`.

    And none rises above that by less than a step. Of parts with the same top the highest answers for all.
    """
    top, covered = parts[k, 2], 0.0
    for i in range(parts.shape[0]):
        area, low, high = parts[i]
        higher = high > top or (i < k and high >= top)
        if (higher and high <= top + _SAME) or (high > top + _SAME and low <= top + step + _SAME):
            return False
        if low >= top - RELIEF and high <= top + _SAME:
            covered += area
    return bool(covered >= _WHOLE * side * side)


def _floor_cells(floor: FloorArea, grid: CellGrid) -> Bools:
    """The cells (nx nz,) in which a place has its ground floor, or nearly."""
    along = np.arange(-_THRESHOLD, grid.cell + _THRESHOLD, floor.cell)
    x, z = (grid.corner[axis] + grid.cell * np.arange(grid.shape[axis])[:, None] + along for axis in (0, 1))
    found = np.zeros(grid.shape, np.bool_)
    for i in range(len(along)):
        for j in range(len(along)):
            found |= floor.holds(*np.broadcast_arrays(x[:, i][:, None], z[:, j][None, :]))
    return found.reshape(-1)
