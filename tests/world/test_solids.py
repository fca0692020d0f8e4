"""What a closed mesh encloses is taken; what it does not enclose is not."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.meshes.solids import inner_boxes
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import rows_of
from elbowroom.world.obstacles.shapes import Mesh
from shapes import box_mesh

Floats = NDArray[np.float64]

UPRIGHT = np.array([[0.0, 0.0, 0.0, 1.0]])
RADIUS = 0.04  # metres: of the smallest capsules of a body


def turned(mesh: Mesh, turn: Floats) -> Mesh:
    return Mesh(quaternion.rotate(turn, mesh.vertices), mesh.faces)


def together(*meshes: Mesh) -> Mesh:
    begins = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + begin for mesh, begin in zip(meshes, begins[:-1], strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def inverted(mesh: Mesh) -> Mesh:
    return Mesh(mesh.vertices, mesh.faces[:, ::-1])


def rock(points: int, size: float) -> Mesh:
    """A convex rock."""
    spots = np.random.default_rng(points).normal(size=(points, 3))
    spots *= size / np.linalg.norm(spots, axis=1, keepdims=True)
    hull = ConvexHull(spots)
    a, b, c = np.moveaxis(spots[hull.simplices], 1, 0)
    outward = np.einsum("ti,ti->t", np.cross(b - a, c - a), hull.equations[:, :3]) > 0.0
    return Mesh(spots, np.where(outward[:, None], hull.simplices, hull.simplices[:, ::-1]))


def winding(points: Floats, mesh: Mesh) -> Floats:
    """How often a surface winds round each point, by solid angles (van Oosterom and Strackee, 1983)."""
    to = mesh.corners[None] - points[:, None, None]
    lengths = np.linalg.norm(to, axis=3)
    a, b, c = np.moveaxis(to, 2, 0)
    above = np.einsum("pti,pti->pt", a, np.cross(b, c))
    below = lengths.prod(axis=2)
    for one, other, rest in ((a, b, 2), (b, c, 0), (a, c, 1)):
        below = below + np.einsum("pti,pti->pt", one, other) * lengths[..., rest]
    return np.asarray(np.arctan2(above, below).sum(axis=1) / (2.0 * np.pi))


SKEW = quaternion.normalize(np.array([0.2, -0.5, 0.1, 0.8]))
SOLIDS = {
    "box": box_mesh((0.5, 1.0, 0.2)),
    "slab askew": turned(box_mesh((1.5, 1.2, 0.045)), SKEW),
    "rock": rock(200, 0.6),
    "boulder": rock(40, 1.5),
    "room in a block": together(box_mesh((2.0, 1.6, 2.0)), inverted(box_mesh((1.7, 1.3, 1.7)))),
    "block with a corner": together(box_mesh((0.6, 0.5, 0.4)), turned(box_mesh((0.3, 0.9, 0.3)), SKEW)),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_points_inside_are_taken_and_points_outside_are_as_free_as_the_surface_says(name: str) -> None:
    mesh, rng = SOLIDS[name], np.random.default_rng(len(name))
    obstacles = Obstacles((mesh,), np.zeros((1, 3)), UPRIGHT, ("it",), ground=-9.0)
    points = rng.uniform(mesh.middle - mesh.half - 0.2, mesh.middle + mesh.half + 0.2, (4000, 3))
    still = np.concatenate([points.T, points.T])[None].astype(np.float32)
    found = clearance(still, [RADIUS], obstacles.standing)
    surface = clearance(still, [RADIUS], rows_of([mesh], np.zeros((1, 3)), UPRIGHT))
    inside = winding(points, mesh) > 0.5
    assert 50 < inside.sum() < 3900
    assert found[inside].max() < 0.0
    np.testing.assert_allclose(found[~inside], surface[~inside], atol=1e-5)


@pytest.mark.parametrize(
    "mesh",
    [
        Mesh(box_mesh((0.5, 1.0, 0.5)).vertices, box_mesh((0.5, 1.0, 0.5)).faces[1:]),  # not closed
        inverted(box_mesh((2.0, 1.5, 2.0))),  # a room
        box_mesh((0.5, 0.5, 0.02)),  # a board
    ],
)
def test_what_encloses_nothing_has_nothing_in_it(mesh: Mesh) -> None:
    assert not len(inner_boxes(mesh).centers)


def test_a_thing_that_is_inside_out_is_no_room_if_nobody_could_stand_there() -> None:
    assert len(inner_boxes(inverted(box_mesh((0.3, 0.4, 0.3)))).centers) == 1


def test_faces_that_are_there_twice_and_corners_that_are_apart_by_rounding_close_a_box_all_the_same() -> None:
    box = box_mesh((0.3, 0.4, 0.3))
    corners = box.corners + np.random.default_rng(0).uniform(-1e-7, 1e-7, box.corners.shape)
    loose = Mesh(corners.reshape(-1, 3), np.arange(36).reshape(-1, 3))
    twice = Mesh(box.vertices, np.concatenate([box.faces, box.faces[3:5], box.faces[:1]]))
    for mesh in (loose, twice):
        assert inner_boxes(mesh).halves.prod() * 8.0 == pytest.approx(8.0 * 0.3 * 0.4 * 0.3, rel=1e-3)
