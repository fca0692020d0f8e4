"""Floors above one another: linked by stairs and ramps, not by what is too high, too steep, too low or too narrow."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.world.places.columns import Columns
from elbowroom.world.places.layers import STEP, Layers, layers_of, link_surfaces, linked_floors, without_edges

CELL = 0.05
Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


def columns_at(heights: Floats, *more: Floats) -> Columns:
    """One level surface over each cell of a grid (nx, nz) for each array of heights; none where that is no number."""
    shape = heights.shape
    rows = [(cell, level.flat[cell]) for cell in range(heights.size) for level in (heights, *more)]
    rows = sorted(row for row in rows if np.isfinite(row[1]))
    cells, low = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    return Columns(
        (0.0, 0.0), CELL, (shape[0], shape[1]), cells, low, low, np.ones(len(rows), bool), np.zeros(len(rows), bool)
    )


def two_floors(profile: Floats, width: int = 24) -> Layers:
    """A floor at 0, then a profile of heights, then a floor at the last of them; `width` cells wide."""
    heights = np.concatenate([np.zeros(30), profile, np.full(30, profile[-1])])
    return layers_of(columns_at(np.repeat(heights[:, None], width, axis=1)))


STAIRS = np.repeat(0.17 * np.arange(1, 17), 5)  # treads of 25 cm, up to 2.72 m
RAMP = 0.5 * CELL * np.arange(1, 110)  # 27 degrees


@pytest.mark.parametrize("profile", [STAIRS, RAMP, np.array([0.38])])
def test_stairs_ramps_and_steps_link_two_floors(profile: Floats) -> None:
    assert linked_floors(two_floors(profile), [0.0, float(profile[-1])]) == [[1], [0]]


@pytest.mark.parametrize("profile", [np.array([0.45]), np.repeat([0.5, 1.0, 1.5], 10)])
def test_what_is_higher_than_a_knee_links_nothing(profile: Floats) -> None:
    assert linked_floors(two_floors(profile), [0.0, float(profile[-1])]) == [[], []]


def test_stairs_that_are_too_narrow_link_nothing() -> None:
    heights = np.full((140, 40), np.nan)
    heights[:30], heights[-30:] = 0.0, 2.72
    heights[30:110, 16:22] = STAIRS[:, None]  # 30 cm
    assert linked_floors(layers_of(columns_at(heights)), [0.0, 2.72]) == [[], []]
    heights[30:110, 8:24] = STAIRS[:, None]
    assert linked_floors(layers_of(columns_at(heights)), [0.0, 2.72]) == [[1], [0]]


def test_a_low_slab_over_the_stairs_closes_them() -> None:
    floors = np.concatenate([np.zeros(30), STAIRS, np.full(30, 2.72)])
    slab = np.where((np.arange(len(floors)) > 60) & (np.arange(len(floors)) < 70), floors + 1.2, np.nan)
    over, under = (np.repeat(each[:, None], 24, axis=1) for each in (slab, floors))
    assert linked_floors(layers_of(columns_at(under, over)), [0.0, 2.72]) == [[], []]
    assert linked_floors(layers_of(columns_at(under, over + 0.3)), [0.0, 2.72]) == [[1], [0]]


def test_two_storeys_without_stairs_are_two_regions() -> None:
    low = np.zeros((30, 30))
    layers = layers_of(columns_at(low, low + 2.7))
    assert linked_floors(layers, [0.0, 2.7]) == [[], []]
    assert set(layers.regions) == {-1, 0, 1}


def random_surfaces(seed: int) -> tuple[Ints, Floats, tuple[int, int]]:
    rng = np.random.default_rng(seed)
    shape = (int(rng.integers(1, 8)), int(rng.integers(1, 8)))
    cells = np.sort(rng.integers(0, shape[0] * shape[1], rng.integers(1, 60)))
    heights = np.empty(len(cells))
    for cell in np.unique(cells):
        heights[cells == cell] = np.sort(rng.uniform(0.0, 3.0, np.count_nonzero(cells == cell)))
    return cells, heights, shape


def naive_link(cells: Ints, heights: Floats, shape: tuple[int, int], n: int, side: int) -> int:
    ix, iz = divmod(int(cells[n]), shape[1])
    jx, jz = ix + (1, 0, -1, 0)[side], iz + (0, 1, 0, -1)[side]
    there = [k for k in range(len(cells)) if divmod(int(cells[k]), shape[1]) == (jx, jz)]
    near = [k for k in there if abs(heights[k] - heights[n]) <= STEP]
    return min(near, key=lambda k: (abs(heights[k] - heights[n]), -k)) if near else -1


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**31))
def test_links_are_those_of_the_slow_twin_and_lead_both_ways(seed: int) -> None:
    cells, heights, shape = random_surfaces(seed)
    starts = np.searchsorted(cells, np.arange(shape[0] * shape[1] + 1))
    links = link_surfaces(cells, heights, starts, *shape, STEP)
    for n in range(len(cells)):
        for side in range(4):
            found = naive_link(cells, heights, shape, n, side)
            back = -1 if found < 0 else naive_link(cells, heights, shape, found, (side + 2) % 4)
            assert links[n, side] == (found if back == n else -1)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**31), st.integers(1, 4))
def test_what_is_left_without_edges_keeps_away_from_them(seed: int, rounds: int) -> None:
    """On one floor with holes: each round takes away at least the four neighbours, at most the eight."""
    there = np.random.default_rng(seed).random((14, 14)) > 0.04
    number = np.where(there, np.cumsum(there).reshape(there.shape) - 1, -1)
    padded = np.pad(number, 1, constant_values=-1)
    moves = ((1, 0), (0, 1), (-1, 0), (0, -1))
    links = np.stack([padded[1 + a : 15 + a, 1 + b : 15 + b] for a, b in moves], axis=-1)[there].astype(np.int32)
    left = np.zeros_like(there)
    left[there] = without_edges(links, rounds)
    holes = np.argwhere(~np.pad(there, 1)) - 1
    for cell in np.argwhere(there):
        away = np.abs(holes - cell)
        if left[tuple(cell)]:
            assert away.sum(axis=1).min() > rounds
        elif away.max(axis=1).min() > rounds:
            pytest.fail("it was taken away although no edge is near")
