"""How deep triangles cross: that far, and no less, one has to be moved for the other library to find them apart."""

import numpy as np
import pytest
from numpy.typing import NDArray

coal = pytest.importorskip("coal", reason="needs coal: pip install 'elbowroom[judge]'")

from elbowroom.experiment.judge.crossing_triangles import crossing_depths  # noqa: E402

Floats = NDArray[np.float64]


def some_pairs() -> tuple[Floats, Floats]:
    """Triangles (N, 3, 3) of all sizes and shapes, most of them slim, some crossing their partners."""
    random = np.random.default_rng(5)
    sizes = random.choice([0.002, 0.03, 0.5], size=(400, 1, 1))
    shape = random.normal(size=(2, 400, 3, 3)) * sizes
    shape[:, ::3, 2] = shape[:, ::3, :2].mean(axis=2) + 0.1 * shape[:, ::3, 2]
    return shape[0], shape[1] + 0.5 * sizes * random.normal(size=(400, 1, 3))


def are_apart(one: Floats, other: Floats) -> bool:
    bodies = [model for corners in (one, other) for model in (of_one(corners), coal.Transform3s())]
    return bool(coal.distance(*bodies, coal.DistanceRequest(), coal.DistanceResult()) > 0.0)


def of_one(corners: Floats) -> object:
    model = coal.BVHModelOBBRSS()
    model.beginModel(1, 3)
    model.addVertices(corners)
    model.addTriangles(np.array([[0, 1, 2]]))
    model.endModel()
    return model


def test_those_apart_have_no_depth_and_those_that_cross_have() -> None:
    one, other = some_pairs()
    crossing = crossing_depths(one, other) > 0.0
    assert 40 < crossing.sum() < 340
    assert crossing.tolist() == [not are_apart(*pair) for pair in zip(one, other, strict=True)]


def test_no_shorter_move_parts_them_and_one_so_long_does() -> None:
    one, other = some_pairs()
    depths, random = crossing_depths(one, other), np.random.default_rng(6)
    for row in np.flatnonzero(depths > 0.0)[:60]:
        ways = random.normal(size=(12, 3))
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        assert not any(are_apart(one[row] + 0.99 * depths[row] * way, other[row]) for way in ways)
        assert any(
            are_apart(one[row] + 1.001 * depths[row] * way, other[row]) for way in ways_out(one[row], other[row])
        )


def ways_out(one: Floats, other: Floats) -> list[Floats]:
    """Unit normals of both, and of what an edge of one and an edge of the other span, to both sides."""
    edges = [[corners[k - 2] - corners[k] for k in range(3)] for corners in (one, other)]
    spans = [np.cross(*sides[:2]) for sides in edges] + [np.cross(a, b) for a in edges[0] for b in edges[1]]
    return [sign * span / np.linalg.norm(span) for span in spans for sign in (1.0, -1.0)]


def test_triangles_without_area_have_none() -> None:
    flat = np.zeros((1, 3, 3))
    assert crossing_depths(flat, flat).tolist() == [0.0]
