"""Boxes seen from other frames."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.boxes import Boxes, tables_in_frames


def _rotations(rng: np.random.Generator, count: int) -> NDArray[np.float64]:
    return quaternion.normalize(rng.normal(size=(count, 4)))


def _boxes(rng: np.random.Generator, count: int) -> Boxes:
    return Boxes(rng.normal(size=(count, 3)), _rotations(rng, count), rng.uniform(0.1, 1.0, (count, 3)))


def _to_box(row: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    local: NDArray[np.float64] = row[3:12].reshape(3, 3) @ (point - row[:3])
    return local


def test_a_point_keeps_its_place_in_the_box_in_every_frame() -> None:
    rng = np.random.default_rng(1)
    boxes = _boxes(rng, 5)
    for _ in range(20):
        position, rotation, local = rng.normal(size=3), _rotations(rng, 1)[0], rng.normal(size=3)
        world = position + quaternion.rotate(rotation, local)
        moved = boxes.in_frame(position, rotation)
        for before, after in zip(boxes.table, moved.table, strict=True):
            np.testing.assert_allclose(_to_box(after, local), _to_box(before, world), atol=1e-12)
            np.testing.assert_array_equal(after[12:], before[12:])


def test_tables_in_frames_are_the_tables_of_boxes_in_each_frame() -> None:
    rng = np.random.default_rng(2)
    boxes, positions, rotations = _boxes(rng, 7), rng.normal(size=(9, 3)), _rotations(rng, 9)
    tables = tables_in_frames(boxes.table, positions, rotations)
    assert tables.shape == (9, 7, 15)
    assert tables.dtype == np.float32
    for table, position, rotation in zip(tables, positions, rotations, strict=True):
        np.testing.assert_allclose(table, boxes.in_frame(position, rotation).table, atol=2e-6)


def test_no_boxes_and_no_frames_give_empty_tables() -> None:
    assert Boxes.empty().table.shape == (0, 15)
    assert tables_in_frames(Boxes.empty().table, np.zeros((3, 3)), np.tile(quaternion.IDENTITY, (3, 1))).shape[1] == 0
    boxes = _boxes(np.random.default_rng(3), 2)
    assert tables_in_frames(boxes.table, np.empty((0, 3)), np.empty((0, 4))).shape == (0, 2, 15)


def test_corners_lie_on_the_faces() -> None:
    boxes = _boxes(np.random.default_rng(4), 3)
    for row, corners in zip(boxes.table, boxes.corners, strict=True):
        for corner in corners:
            np.testing.assert_allclose(np.abs(_to_box(row, corner)), row[12:], atol=1e-12)
