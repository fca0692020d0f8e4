"""Triangles over the cells of a grid, against a slow twin that cuts each triangle by each cell."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.world.ground import cells
from elbowroom.world.ground.cells import CellGrid, CellParts, cell_by_cell, grid_over, parts_of
from elbowroom.world.ground.making import planes_of

Floats = NDArray[np.float64]

HAIR = 1e-4  # metres by which what is known of a part is wide of it


def triangles(seed: int, count: int = 60) -> Floats:
    """Some (n, 3, 3) over a few metres, none steeper than one in two."""
    rng = np.random.default_rng(seed)
    offsets = rng.uniform(-0.5, 0.5, (count, 3, 3))
    offsets[:, :, 1] = np.sum(offsets[:, :, [0, 2]] * rng.uniform(-0.35, 0.35, (count, 1, 2)), axis=2)
    found: Floats = offsets + rng.uniform(-1.0, 1.0, (count, 1, 3)) * [1.5, 3.0, 1.0]
    return found


def cut(triangle: Floats, corner: Floats, side: float) -> Floats:
    """The corners (n, 3) of what a square leaves of a triangle seen from above."""
    piece = list(triangle)
    for axis, way, at in ((0, 1, corner[0]), (0, -1, corner[0] + side), (2, 1, corner[1]), (2, -1, corner[1] + side)):
        out: list[Floats] = []
        for a, b in zip(piece, piece[1:] + piece[:1], strict=True):
            u, v = way * (a[axis] - at), way * (b[axis] - at)
            if u >= 0.0:
                out.append(a)
            if u * v < 0.0:
                out.append(a + (b - a) * u / (u - v))
        piece = out
    return np.array(piece).reshape(-1, 3)


@pytest.mark.parametrize("seed", range(3))
def test_each_cell_has_the_parts_in_it_as_low_and_as_high_as_they_are(seed: int) -> None:
    there, grid = triangles(seed), CellGrid((-2.1, -1.6), 0.3, (14, 11))
    parts = parts_of(planes_of(there), grid)
    known = {(int(c), int(t)): (low, high) for c, t, low, high in zip(*parts, strict=True)}
    assert len(known) == len(parts.cells)
    for cell in range(grid.cells):
        corner = np.array(grid.corner) + grid.cell * np.array(divmod(cell, grid.shape[1]))
        for t, triangle in enumerate(there):
            piece, about = cut(triangle, corner, grid.cell), cut(triangle, corner - HAIR, grid.cell + 2.0 * HAIR)
            assert ((cell, t) in known) == (len(about) > 0)
            if len(about):
                low, high = known[cell, t]
                np.testing.assert_allclose([low, high], [about[:, 1].min() - HAIR, about[:, 1].max() + HAIR], atol=1e-6)
                assert np.all((low <= piece[:, 1]) & (piece[:, 1] <= high))


@pytest.mark.parametrize("seed", range(3))
def test_of_each_cell_those_come_first_that_begin_higher_and_tops_are_of_all_that_follow(seed: int) -> None:
    grid = CellGrid((-2.1, -1.6), 0.3, (14, 11))
    firm, more = parts_of(planes_of(triangles(seed)), grid), parts_of(planes_of(triangles(9)), grid, first=60)
    both = CellParts(*(np.concatenate(pair) for pair in zip(firm, more, strict=True)))
    starts, members, bottoms, tops = cell_by_cell(both, grid)
    assert starts[0] == 0
    assert starts[-1] == len(members) == len(both.cells)
    for cell in range(grid.cells):
        own, here = both.cells == cell, slice(starts[cell], starts[cell + 1])
        highest = dict(zip(both.triangles[own].tolist(), both.tops[own].tolist(), strict=True))
        lowest = dict(zip(both.triangles[own].tolist(), both.bottoms[own].tolist(), strict=True))
        numbers = members[here].tolist()
        assert sorted(numbers) == sorted(highest)
        assert bottoms[here].tolist() == sorted(lowest.values(), reverse=True) == [lowest[t] for t in numbers]
        assert tops[here].tolist() == [max(highest[t] for t in numbers[k:]) for k in range(len(numbers))]


def test_cells_grow_until_they_hold_no_more_parts_than_there_is_room_for(monkeypatch: pytest.MonkeyPatch) -> None:
    there = triangles(1, 500)
    fine = grid_over(there, None)
    monkeypatch.setattr(cells, "_MOST_PARTS", 4000)
    grid = grid_over(there, None)
    assert grid.cell in (2.0 * fine.cell, 4.0 * fine.cell, 8.0 * fine.cell)
    assert len(parts_of(planes_of(there), fine).cells) > 4000
    assert 100 < len(parts_of(planes_of(there), grid).cells) <= 4000
