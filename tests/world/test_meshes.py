"""Meshes: cut into pieces, packed and held against capsules, they stay the surface that they are."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.closest_points import closest_points
from elbowroom.world.obstacles.meshes.clusters import clusters_of
from elbowroom.world.obstacles.meshes.mesh_pieces import pieces_of
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import about, rows_of
from elbowroom.world.obstacles.shapes import Mesh
from elbowroom.world.scene import Scene
from shapes import box_mesh, soup

Floats = NDArray[np.float64]

UPRIGHT = np.array([[0.0, 0.0, 0.0, 1.0]])
WALL = np.array([[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 2.5, 0.0], [-3.0, 2.5, 0.0]])
SQUARE = np.array([[0, 1, 2], [0, 2, 3]])


def standing(mesh: Mesh, center: tuple[float, float, float] = (0.0, 0.0, 0.0), ground: float = -9.0) -> Obstacles:
    return Obstacles((mesh,), np.array([center]), UPRIGHT, ("thing",), ground=ground)


def axes(rng: np.random.Generator, count: int) -> NDArray[np.float32]:
    starts = rng.uniform(-1.0, 1.0, (3, count))
    return np.concatenate([starts, starts + rng.uniform(-0.4, 0.4, (3, count))]).astype(np.float32)


def point_distances(points: Floats, mesh: Mesh) -> Floats:
    """The slow twin: the distance of each point (N, 3) from the nearest triangle, by regions of its plane."""
    out = np.full(len(points), np.inf)
    for a, b, c in mesh.corners:
        weights = np.linspace(0.0, 1.0, 41)
        u, v = (grid.ravel() for grid in np.meshgrid(weights, weights))
        inside = u + v <= 1.0 + 1e-12
        grid = a + u[inside, None] * (b - a) + v[inside, None] * (c - a)
        out = np.minimum(out, np.linalg.norm(points[:, None] - grid, axis=2).min(axis=1))
    return out


def test_an_axis_is_as_far_as_the_nearest_of_its_points_and_the_triangles() -> None:
    rng = np.random.default_rng(1)
    mesh = soup(rng, 12)
    segments = axes(rng, 60)
    found = clearance(segments[None], [0.0], rows_of([mesh], np.zeros((1, 3)), UPRIGHT))
    shares = np.linspace(0.0, 1.0, 41)[:, None]
    for i, (begin, end) in enumerate(zip(segments[:3].T, segments[3:].T, strict=True)):
        coarse = float(point_distances(begin + shares * (end - begin), mesh).min())
        assert coarse - 0.03 < found[i] < coarse + 1e-6  # both grids are as fine as that


def test_pieces_hold_the_surface_of_the_whole() -> None:
    rng = np.random.default_rng(2)
    mesh = soup(rng, 700, 0.5)
    whole, pieces = rows_of([mesh], np.zeros((1, 3)), UPRIGHT), standing(mesh).standing
    assert len(pieces.rows) > 10
    segments = axes(rng, 500)[None]
    np.testing.assert_allclose(clearance(segments, [0.05], pieces), clearance(segments, [0.05], whole), atol=1e-6)


def test_clusters_are_of_one_and_small_and_lie_close() -> None:
    rng = np.random.default_rng(3)
    corners, whose = rng.uniform(-5.0, 5.0, (900, 1, 3)) + rng.uniform(-0.2, 0.2, (900, 3, 3)), rng.integers(0, 4, 900)
    for most in (8, 64):
        found = clusters_of(corners, whose, 8, most, 1.0)
        for number in range(int(found.max()) + 1):
            own = found == number
            close = np.ptp(corners[own].reshape(-1, 3), axis=0).max() <= 1.0
            assert 0 < own.sum() <= (most if close else 8)
            assert len(set(whose[own])) == 1


def test_long_triangles_are_halved_and_what_is_near_is_a_part() -> None:
    ground = Mesh(np.array([[-50.0, 1.0, -50.0], [50.0, 1.0, -50.0], [50.0, 1.0, 50.0], [-50.0, 1.0, 50.0]]), SQUARE)
    found = standing(ground)
    areas = [np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1).sum() / 2.0
             for c in (piece.corners for piece in pieces_of(ground))]  # fmt: skip
    assert sum(areas) == pytest.approx(10_000.0)
    assert len(found.numbers_near((0.0, 0.0), (1.0, 1.0))) < 0.05 * len(found.standing.rows)


def test_a_thin_wall_is_passed_at_no_speed() -> None:
    """Before and behind it a body is free; no bound on what it moves between can be read off these two clearances."""
    wall = standing(Mesh(WALL, SQUARE)).standing
    for step in (0.3, 0.6, 1.2):
        z = np.array([-0.5 * step, 0.5 * step], np.float32)
        ends = np.stack([np.zeros(2), np.full(2, 1.0), z, np.zeros(2), np.full(2, 1.4), z]).astype(np.float32)
        before, behind = clearance(ends[None], [0.05], wall)
        assert min(before, behind) > 0.0
        assert 0.5 * (before + behind - step) <= -0.05 + 1e-6


@pytest.mark.parametrize("far", [0.0, 1e4])
def test_slivers_doubles_and_points_do_no_harm(far: float) -> None:
    rng = np.random.default_rng(5)
    line = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]])
    odd = np.concatenate([WALL, line, line[:1] + 1e-9, WALL[:1]])
    faces = np.concatenate([SQUARE, SQUARE, SQUARE[:, ::-1], [[4, 5, 6], [4, 4, 6], [5, 5, 5], [4, 7, 6], [8, 1, 2]]])
    clean = Mesh(WALL, SQUARE)
    segments = axes(rng, 400)
    segments[[1, 4]] += 1.0
    near = [about(standing(mesh, (far, 0.0, far)).standing, far, far) for mesh in (Mesh(odd, faces), clean)]
    both = [clearance(segments[None], [0.0], one) for one in near]
    assert np.isfinite(both[0]).all()
    assert both[0].min() >= 0.0
    np.testing.assert_allclose(both[0], both[1], atol=2e-6)


def test_the_ground_is_not_in_the_way_and_what_rises_from_it_is() -> None:
    floor = np.array([[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 0.004, 6.0], [-3.0, 0.0, 6.0]])
    assert not len(standing(Mesh(floor, SQUARE), ground=0.0).standing.rows)
    both = Mesh(np.concatenate([floor, WALL]), np.concatenate([SQUARE, SQUARE + 4]))
    found = standing(both, ground=0.0)
    foot = np.array([[0.0, 0.03, 1.0, 0.0, 0.03, 1.2]], np.float32)
    assert found.clearance(foot[:, :, None], [0.03], (0.0, 0.0), 0.0) == pytest.approx(0.97, abs=1e-6)
    assert set(found.names) == {"thing"}


def test_the_nearest_points_lie_on_both() -> None:
    rng = np.random.default_rng(7)
    found = standing(soup(rng, 60))
    for segment in axes(rng, 50).T.astype(np.float64):
        nearest = found.nearest(segment[None], [0.04], (0.0, 0.0), 0.0)
        assert nearest is not None
        assert np.linalg.norm(nearest.on_axis - nearest.on_obstacle) == pytest.approx(nearest.distance + 0.04, abs=2e-6)
        again, _ = closest_points(np.tile(nearest.on_obstacle, 2), found.standing)
        assert again.shape == (len(found.standing.rows), 3)


@pytest.mark.parametrize(
    ("vertices", "faces", "said"),
    [
        (WALL, np.empty((0, 3)), "no triangles"),
        (WALL, [[0, 1, 4]], "not there; there are 4"),
        (WALL, [[0, 1, -1]], "not there"),
        (WALL * np.nan, SQUARE, "not a finite number"),
    ],
)
def test_what_is_no_mesh_is_refused(vertices: Floats, faces: NDArray[np.int64], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Mesh(vertices, np.asarray(faces))


def test_a_scene_with_a_mesh_is_written_and_read_again() -> None:
    row = {"type": "mesh", "name": "box", "center": [0.0, 1.0, 3.0], "yaw": 0.5}
    mesh = box_mesh((0.5, 0.5, 0.5))
    row |= {"vertices": mesh.vertices.tolist(), "faces": mesh.faces.tolist()}
    scene = Scene.of("meshed", [row], finish=(0.0, 6.0))
    again = Scene.from_dict(scene.to_dict())
    assert again.to_dict() == scene.to_dict()
    np.testing.assert_array_equal(again.obstacles.standing.rows, scene.obstacles.standing.rows)
    for field, wrong in (("faces", [[0, 1, 8]]), ("faces", [[0, 1, 2.5]]), ("vertices", [[0, 0, 0]]), ("faces", [])):
        with pytest.raises(InputError, match=field):
            Scene.of("meshed", [row | {field: wrong}], finish=(0.0, 6.0))


def test_the_least_clearance_among_many_pieces_is_that_from_all_of_them() -> None:
    rng = np.random.default_rng(9)
    obstacles = standing(soup(rng, 6000, 2.0))
    assert len(obstacles.standing.rows) > 500
    for around in (0.3, 3.0, 30.0):
        for begin in rng.uniform(-around, around, (20, 3)):
            axis = np.concatenate([begin, begin + rng.uniform(-0.3, 0.3, 3)]).astype(np.float32)[None]
            found = obstacles.clearance(axis[:, :, None], [0.04], (0.0, 0.0), 0.0)
            assert found == pytest.approx(float(clearance(axis[:, :, None], [0.04], obstacles.standing)[0]), abs=1e-7)
