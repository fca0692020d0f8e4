"""What lies within closed solids is no floor: against blocks whose inside is known."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from elbowroom.world.obstacles.meshes.solids import enclosing_triangles
from elbowroom.world.obstacles.shapes import Mesh
from elbowroom.world.places.columns import columns_of
from elbowroom.world.places.enclosed import enclosed
from elbowroom.world.places.floors import floors_of
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.reading import parse_place
from place_builder import TRIANGLES, Boxes, glb

Floats = NDArray[np.float64]

FLOOR = {"Floor": ((0.0, -0.05, 0.0), (10.0, 0.1, 10.0))}  # its top at 0


def box(size: Floats, turn: Rotation, middle: Floats) -> Mesh:
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    return Mesh(turn.apply(corners * size) + middle, TRIANGLES)


@pytest.mark.parametrize("seed", range(5))
def test_random_blocks_hold_what_lies_in_them(seed: int) -> None:
    """Against each block's own axes; what is within a few centimetres of a face may be either."""
    rng = np.random.default_rng(seed)
    shape, cell = (30, 20), 0.25
    blocks = [(rng.uniform(0.5, 3.0, 3), Rotation.random(rng=rng), rng.uniform(1.0, 4.0, 3)) for _ in range(4)]
    triangles = np.concatenate([enclosing_triangles(box(*block)) for block in blocks])
    cells, heights = rng.integers(0, shape[0] * shape[1], 4000), rng.uniform(-1.0, 7.0, 4000)
    places = np.stack([(cells // shape[1] + 0.5) * cell, heights + 0.05, (cells % shape[1] + 0.5) * cell], axis=1)
    depth = np.max(
        [(0.5 * size - np.abs(turn.inv().apply(places - middle))).min(axis=1) for size, turn, middle in blocks], axis=0
    )
    clear = np.abs(depth) > 1e-6
    found = enclosed(cells, heights, triangles, cell, shape)
    assert np.array_equal(found[clear], depth[clear] > 0.0)
    assert 50 < found.sum() < 3950


def heights_of(boxes: Boxes) -> list[float]:
    columns = columns_of(parse_place(glb(boxes), "blocks.glb", PlaceOptions()))
    return [round(floor.height, 2) for floor in floors_of(columns)]


def test_the_underside_of_a_block_is_no_floor_and_its_top_is_one() -> None:
    assert heights_of({"Block": ((0.0, 0.0, 0.0), (6.0, 4.0, 6.0))}) == [2.0]


def test_a_floor_that_runs_on_in_a_block_ends_at_it() -> None:
    sunk = {**FLOOR, "Block": ((2.5, 1.0, 0.0), (5.0, 6.0, 10.0))}
    columns = columns_of(parse_place(glb(sunk), "blocks.glb", PlaceOptions()))
    floor = floors_of(columns)[0]
    assert floor.height == pytest.approx(0.0, abs=0.02)
    assert (floor.room > 0.0).sum() * columns.cell**2 == pytest.approx(50.0, rel=0.05)
