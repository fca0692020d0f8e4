"""The ground under feet: heights are where trimesh's rays hit, soles lie on what they stand on."""

import math
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.ground.ground import (
    STEP,
    Ground,
    eased_height,
    firm_at,
    height_along,
    height_at,
    level_about,
    under_body,
)
from elbowroom.world.ground.sole import Sole, sole_on
from elbowroom.world.obstacles.triangles import triangles_of
from elbowroom.world.scene import Scene
from sampled import sampled

Floats = NDArray[np.float64]
SOLE = Sole(0.06, 0.18, 0.04)


def scene_with(*obstacles: dict[str, Any]) -> Scene:
    return Scene.of("ground", obstacles, finish=(0.0, 6.0))


def box(center: tuple[float, float, float], size: tuple[float, float, float], **turned: Any) -> dict[str, Any]:
    return {"type": "box", "center": list(center), "size": list(size), **turned}


def ramp(grade: float, begin: float = 1.0, run: float = 2.0, width: float = 2.0) -> dict[str, Any]:
    """A wedge that rises from z = `begin` on."""
    top, half = grade * run, 0.5 * width
    points = [[x, y, z] for x in (-half, half) for y, z in ((0.0, 0.0), (0.0, run), (top, run))]
    return {"type": "hull", "points": points, "center": [0.0, 0.0, begin]}


@pytest.mark.parametrize("name", Scene.stock_names())
def test_the_stock_scenes_are_plain(name: str) -> None:
    assert Scene.load(name).ground.plain


def test_what_is_as_low_as_a_step_makes_ground_that_is_not_plain() -> None:
    assert not scene_with(box((0.0, 0.05, 2.0), (1.0, 0.1, 1.0))).ground.plain
    assert scene_with(box((0.0, 0.5, 2.0), (1.0, 1.0, 1.0))).ground.plain
    assert scene_with(box((0.0, 0.001, 2.0), (1.0, 0.002, 1.0))).ground.plain, "a mat is the plane"
    assert scene_with(ramp(1.0)).ground.plain, "too steep to stand on"
    assert not scene_with(ramp(0.2)).ground.plain


def hits(scene: Scene, x: float, z: float) -> list[float]:
    """The heights of all surfaces over a place that one could stand on: each triangle by itself."""
    found = []
    for _, shape, center, turn in scene.obstacles:
        corners = quaternion.rotate(turn, triangles_of(shape).reshape(-1, 3)) + center
        mesh = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3), process=False)
        for (a, b, c), normal in zip(mesh.triangles, mesh.face_normals, strict=True):
            if normal[1] < math.cos(math.radians(30.0)):
                continue
            edges = np.stack([b - a, c - a], axis=1)[[0, 2]]
            u, v = np.linalg.solve(edges, np.array([x, z]) - a[[0, 2]])
            if min(u, v, 1.0 - u - v) >= 0.0:
                found.append(float(a[1] + u * (b - a)[1] + v * (c - a)[1]))
    return found


def random_scene(rng: np.random.Generator) -> Scene:
    obstacles = []
    for _ in range(12):
        x, z = rng.uniform(-2.0, 2.0, 2)
        y = rng.uniform(0.0, 0.6)
        size = rng.uniform(0.1, 1.2, 3)
        turn = quaternion.normalize(np.array([*rng.uniform(-0.2, 0.2, 3), 1.0])).tolist()
        kind = rng.integers(3)
        if kind == 0:
            obstacles.append(box((x, y, z), tuple(size), rotation=turn))
        elif kind == 1:
            own = {"type": "cylinder", "radius": float(size[0]), "height": float(size[1]), "rotation": turn}
            obstacles.append(own | {"center": [x, y, z]})
        else:
            points = rng.uniform(-0.6, 0.6, (8, 3)).tolist()
            obstacles.append({"type": "hull", "points": points, "center": [x, y, z], "rotation": turn})
    return Scene.of("heap", obstacles, start=(-9.0, 0.0), finish=(9.0, 6.0))


@pytest.mark.parametrize("seed", sampled(range(3)))
def test_heights_are_where_rays_hit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = random_scene(rng)
    ground = scene.ground
    assert not ground.plain
    for _ in range(60):
        (x, z), near = rng.uniform(-2.5, 2.5, 2).tolist(), float(rng.uniform(0.0, 0.8))
        wanted = [y for y in [0.0, *hits(scene, x, z)] if abs(y - near) <= STEP]
        found = height_at(ground, x, z, near)
        assert found == pytest.approx(max(wanted, default=-math.inf), abs=1e-6), (x, z, near)


def test_far_from_everything_the_ground_is_the_plane_or_nothing() -> None:
    ground = scene_with(box((0.0, 0.05, 2.0), (1.0, 0.1, 1.0))).ground
    assert height_at(ground, 50.0, -50.0, 0.1) == 0.0
    assert height_at(ground, 50.0, -50.0, 0.5) == -math.inf


def test_a_stair_is_climbed_step_by_step_and_a_wall_is_not() -> None:
    steps = [box((0.0, 0.085 * (i + 1), 1.14 + 0.28 * i), (1.0, 0.17 * (i + 1), 0.28)) for i in range(5)]
    ground = scene_with(*steps, box((0.0, 1.0, -1.0), (1.0, 2.0, 0.3))).ground
    assert height_along(ground, (0.0, 0.0, 0.0), 0.0, 1.2 + 4 * 0.28) == pytest.approx(0.85)
    assert height_along(ground, (0.0, 0.85, 2.3), 0.0, 0.0) == pytest.approx(0.0)
    assert height_along(ground, (0.0, 0.0, 0.0), 0.0, -1.0) == pytest.approx(0.0)


def test_floors_above_one_another_are_told_apart_by_the_height_asked_for() -> None:
    ground = scene_with(box((0.0, 0.1, 2.0), (1.0, 0.2, 1.0)), box((0.0, 2.9, 2.0), (1.0, 0.2, 1.0))).ground
    assert height_at(ground, 0.0, 2.0, 0.0) == pytest.approx(0.2)
    assert height_at(ground, 0.0, 2.0, 3.1) == pytest.approx(3.0)
    assert height_at(ground, 0.0, 2.0, 1.5) == -math.inf


@pytest.mark.parametrize("yaw", [0.0, 0.7, math.pi])
def test_a_sole_lies_on_a_slope(yaw: float) -> None:
    grade = math.tan(math.radians(15.0))
    ground = scene_with(ramp(grade)).ground
    height, pitch = sole_on(ground, SOLE, (0.0, 0.25, 2.0), yaw)
    along = grade * math.cos(yaw)
    assert pitch == pytest.approx(-math.atan(along), abs=1e-9)
    assert height == pytest.approx(grade + SOLE.aside * abs(grade * math.sin(yaw)), abs=1e-9)


def below_ground(ground: Ground, sole: Sole, place: tuple[float, float, float], yaw: float) -> float:
    """How far the sole is in the ground at most, which is followed step by step from the ankle to toes and heel."""
    height, pitch = sole_on(ground, sole, place, yaw)
    rows, nears, deepest = np.linspace(-sole.back, sole.ahead, 13), np.empty(13), -math.inf

    def highest(ahead: float, asides: Floats, near: float) -> float:
        x = place[0] + ahead * math.sin(yaw) + asides * math.cos(yaw)
        z = place[2] + ahead * math.cos(yaw) - asides * math.sin(yaw)
        return max(firm_at(ground, *at, near) for at in zip(x.tolist(), z.tolist(), strict=True))

    ankle = int(np.argmin(np.abs(rows)))
    for way in (range(ankle, 13), range(ankle - 1, -1, -1)):
        near = place[1]
        for i in way:
            found = highest(rows[i], np.linspace(-sole.aside, sole.aside, 3), near)
            near = nears[i] = found if math.isfinite(found) else near
    for ahead in np.linspace(-sole.back, sole.ahead, 73).tolist():
        near = nears[int(np.argmin(np.abs(rows - ahead)))]
        found = highest(ahead, np.linspace(-sole.aside, sole.aside, 41), near)
        deepest = max(deepest, found - (height - ahead * math.tan(pitch)))
    return deepest


@pytest.mark.parametrize("seed", range(3))
def test_no_sole_is_in_the_ground_and_all_touch_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ground = random_scene(rng).ground
    for _ in range(40):
        x, z, y, yaw = rng.uniform((-2.5, -2.5, 0.0, -3.0), (2.5, 2.5, 0.2, 3.0)).tolist()
        assert -0.002 < below_ground(ground, SOLE, (x, y, z), yaw) < 2.5e-4  # looked at every 3 mm


def test_a_sole_lies_on_a_ridge_between_the_places_that_are_looked_at() -> None:
    turned = quaternion.about_axis(2, math.radians(25.0)).tolist()
    ridge = scene_with(box((0.02, 0.0, 2.0), (0.03, 0.03, 4.0), rotation=turned)).ground
    top = 0.015 * (math.cos(math.radians(25.0)) + math.sin(math.radians(25.0)))
    assert sole_on(ridge, SOLE, (0.0, 0.0, 2.0), 0.0) == pytest.approx((top, 0.0), abs=1e-6)


def test_on_an_edge_and_on_a_cable_a_sole_is_level_and_on_the_highest() -> None:
    kerb = scene_with(box((0.0, 0.075, 3.0), (4.0, 0.15, 2.0))).ground
    assert sole_on(kerb, SOLE, (0.0, 0.0, 1.9), 0.0) == pytest.approx((0.15, 0.0))
    cable = scene_with(box((0.0, 0.03, 2.0), (4.0, 0.06, 0.02))).ground
    assert sole_on(cable, Sole(0.06, 0.18, 0.04), (0.0, 0.0, 1.988), 0.0) == pytest.approx((0.06, 0.0))


@pytest.mark.parametrize("times", [1, 2])
def test_where_ground_is_told_to_be_level_it_is(times: int) -> None:
    """Against `height_at` at many places, over steps and holes between boxes; also where each box is there twice."""
    boxes = [
        box((x, 0.5 * top, z), (wide, top, wide))
        for x, z, top, wide in [(1, 2, 0.1, 1.0), (2, 2, 0.2, 1.0), (1, 3, 0.1, 0.96), (3, 5, 0.15, 0.92)]
    ]
    ground = scene_with(*(times * boxes)).ground
    rng, told = np.random.default_rng(3), 0
    for x, z in rng.uniform((-1.0, 0.0), (4.0, 7.0), (400, 2)):
        reach, near = float(rng.uniform(0.05, 0.5)), float(rng.choice([0.0, 0.1, 0.2]))
        level = level_about(ground, x, z, reach, near)
        if math.isfinite(level):
            told += 1
            around = np.array([x, z]) + rng.uniform(-reach, reach, (50, 2))
            heights = [height_at(ground, float(a), float(b), level) for a, b in around]
            assert heights == pytest.approx([level] * len(heights), abs=1e-3)
    assert told > 100, "level ground is hardly ever noticed"


@pytest.mark.parametrize("grade", [0.55, 0.85, 1.0])
def test_on_steep_treads_a_body_is_carried_higher_but_on_no_ramp(grade: float) -> None:
    """By a tenth of a metre where treads rise by one in one; on an even stair and on a ramp it is as high as these."""
    rise = 0.17
    deep = rise / grade
    treads = [box((0.0, 0.5 * rise * i, deep * i), (2.0, rise * i, deep)) for i in range(1, 11)]
    stair, slope = scene_with(*treads).ground, scene_with(ramp(0.5)).ground
    more, near = [], rise * 4
    for z in np.linspace(4.0 * deep, 6.0 * deep, 21).tolist():
        near = eased_height(stair, (0.0, near, z), 0.0, z)
        more.append(near - grade * z)
    assert np.mean(more) == pytest.approx(max(0.3 * (grade - 0.65), 0.0), abs=0.02)
    assert np.ptp(more) < 0.4 * rise, "it goes up more evenly than the treads"
    assert eased_height(slope, (0.0, 0.5, 2.0), 0.0, 2.0) == pytest.approx(0.5, abs=0.01)


def test_the_ground_under_a_body_is_found_wherever_it_is_carried() -> None:
    """On and about kerbs and treads, and from what a body is carried over them: that of its place."""
    treads = [box((0.0, 0.09 * i, 1.0 + 0.18 * i), (2.0, 0.18 * i, 0.18)) for i in range(1, 9)]
    for ground in (scene_with(*treads).ground, scene_with(box((0.0, 0.1, 3.0), (2.0, 0.2, 2.0))).ground):
        near, height = 0.0, 0.0
        for z in np.linspace(0.5, 2.4, 150).tolist():
            near = height_along(ground, (0.0, near, z - 0.01), 0.0, z)
            height = eased_height(ground, (0.0, height, z - 0.01), 0.0, z)
            assert under_body(ground, 0.0, height, z) == pytest.approx(near)
