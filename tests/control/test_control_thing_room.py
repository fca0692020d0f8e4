"""What is pushed stops at walls and other things, whatever shape they have; points on its surface are the judge."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from elbowroom.control.things.loose import Hand, Loose, Thing
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.shapes import Capsule, Cylinder, Hull, Sphere, extents_of
from elbowroom.world.scene import Scene
from sampled import sampled

STEP = 1 / 60
THINGS: list[dict[str, Any]] = [
    {"type": "box", "name": "crate", "center": [2.0, 0.8, 2.5], "size": [0.5, 1.6, 0.5], "yaw": 0.4},
    {"type": "cylinder", "name": "column", "center": [-2.0, 0.9, 1.0], "radius": 0.2, "height": 1.8},
    {"type": "sphere", "name": "ball", "center": [1.6, 1.1, 0.0], "radius": 0.3},
]


def pushed_to(loose: Loose, number: int, place: tuple[float, float], steps: int = 240) -> Thing:
    """A thing, after it was pushed for some seconds with nobody there."""
    loose.take(Hand(number, place), lambda _thing: False)
    for step in range(steps):
        loose.advance(STEP * step, STEP, lambda _thing, _way: True)
    return loose.things[number]


def loose_in(things: list[dict[str, Any]]) -> Loose:
    return Loose(Scene.of("stops", things, finish=(0.0, 6.0)))


WALL: dict[str, Any] = {"type": "box", "center": [0.0, 1.0, 4.0], "size": [8.0, 2.0, 0.02]}
IN_THE_WAY: list[dict[str, Any]] = [
    WALL,
    {"type": "cylinder", "center": [0.0, 1.0, 4.0], "radius": 0.2, "height": 2.0},
    {"type": "sphere", "center": [0.0, 1.0, 4.0], "radius": 0.4},
    {"type": "capsule", "center": [0.0, 1.0, 4.0], "radius": 0.3, "length": 0.6},
    {"type": "box", "center": [0.0, 1.2, 4.0], "size": [0.6, 0.02, 0.02], "yaw": 0.7},  # a rail between the edges
    {
        "type": "hull",
        "center": [0.0, 0.0, 4.0],
        "points": [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.6], [0.0, 2.0, 0.2]],
    },
]


@pytest.mark.parametrize("thing", sampled(THINGS), ids=["box", "cylinder", "sphere"])
@pytest.mark.parametrize("barrier", IN_THE_WAY, ids=["wall", "column", "ball", "capsule", "rail", "hull"])
def test_a_pushed_thing_stops_at_what_stands(thing: dict[str, Any], barrier: dict[str, Any]) -> None:
    mine = {**thing, "center": [0.0, thing["center"][1], 2.0]}
    there = pushed_to(loose_in([mine, barrier]), 0, (0.0, 6.0))
    assert 2.3 < there.place[1] < 4.4
    assert free_of(there, Scene.of("alone", [barrier], finish=(0.0, 6.0)))


def free_of(thing: Thing, scene: Scene) -> bool:
    """Whether a thing is no farther in anything than its skin, judged by points of its surface in another way."""
    rng = np.random.default_rng(3)
    points = thing.center + surface_points(thing, rng, 4000)
    _, shape, center, turn = next(iter(scene.obstacles))
    own = quaternion.rotate(quaternion.conjugate(turn), points - center)
    return bool((depth_in(shape, own) < 0.012).all())


def surface_points(thing: Thing, rng: np.random.Generator, count: int) -> Any:
    """Random points on a thing, about its middle."""
    match thing.shape:
        case Sphere(radius=radius):
            way = rng.normal(size=(count, 3))
            return radius * way / np.linalg.norm(way, axis=1, keepdims=True)
        case Cylinder(radius=radius, height=height):
            angle = rng.uniform(0.0, 2.0 * np.pi, count)
            up = rng.uniform(-0.5, 0.5, count) * height
            return np.stack([radius * np.cos(angle), up, radius * np.sin(angle)], axis=1)
        case shape:
            half = extents_of(shape)
            points = rng.uniform(-half, half, (count, 3))
            side = rng.choice([0, 2], count)
            points[np.arange(count), side] = np.sign(points[np.arange(count), side]) * half[side]
            return quaternion.rotate(quaternion.about_axis(1, np.array([thing.yaw]))[0], points)


def depth_in(shape: Any, points: Any) -> Any:
    """How deep points are in a shape, about its origin; negative outside."""
    match shape:
        case Sphere(radius=radius):
            return radius - np.linalg.norm(points, axis=1)
        case Capsule(radius=radius, length=length):
            along = np.clip(points[:, 1], -0.5 * length, 0.5 * length)
            return radius - np.linalg.norm(points - np.stack([0.0 * along, along, 0.0 * along], axis=1), axis=1)
        case Cylinder(radius=radius, height=height):
            return np.minimum(radius - np.hypot(points[:, 0], points[:, 2]), 0.5 * height - np.abs(points[:, 1]))
        case Hull():
            hull = ConvexHull(shape.array)
            return -(points @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
        case _:
            return (extents_of(shape) - np.abs(points)).min(axis=1)


def test_a_pushed_thing_stops_at_another_and_goes_along_a_wall() -> None:
    crates = [{"type": "box", "center": [0.0, 0.8, z], "size": [0.5, 1.6, 0.5]} for z in (1.0, 2.5, 3.735)]
    loose = loose_in([*crates, WALL])
    pushed_to(loose, 1, (0.0, 2.4))
    assert pushed_to(loose, 0, (0.0, 6.0)).place == pytest.approx((0.0, 1.9), abs=0.04)
    pressed = pushed_to(loose, 2, (2.0, 6.0))  # flush with the wall from the beginning
    assert 1.8 < pressed.place[0] < 2.0
    assert pressed.place[1] == pytest.approx(3.735, abs=0.01)


def test_what_lies_on_a_thing_or_in_one_can_be_pushed_off_it() -> None:
    table = {"type": "box", "center": [0.0, 0.35, 2.0], "size": [1.0, 0.7, 1.0]}
    vase = {"type": "cylinder", "center": [0.0, 0.9, 2.0], "radius": 0.1, "height": 0.4}
    peg = {"type": "cylinder", "center": [0.0, 0.9, 2.0], "radius": 0.05, "height": 0.9}
    assert pushed_to(loose_in([table, vase]), 1, (2.0, 2.0)).place == pytest.approx((2.0, 2.0), abs=0.02)
    assert pushed_to(loose_in([table, peg]), 1, (2.0, 2.0)).place == pytest.approx((2.0, 2.0), abs=0.02)


@pytest.mark.parametrize(
    "repeat", ["loop", *(pytest.param(one, marks=pytest.mark.long) for one in ("pingpong", "once"))]
)
@pytest.mark.parametrize("thing", sampled(THINGS), ids=["box", "cylinder", "sphere"])
def test_what_moves_by_itself_never_enters_what_was_pushed(thing: dict[str, Any], repeat: str) -> None:
    rng = np.random.default_rng(len(repeat) + len(thing))
    for _ in range(4):
        yaws = rng.uniform(-1.5, 1.5, 3)
        track = [
            {"center": [*rng.uniform((-2.0, 0.6), (2.0, 1.2)), z], "yaw": yaw, "seconds": rng.uniform(0.5, 3.0)}
            for z, yaw in zip(rng.uniform(3.0, 5.0, 3), yaws, strict=True)
        ]
        trolley = {"type": "box", "size": [0.6, 1.0, 0.4], "repeat": repeat, "track": track}
        scene = Scene.of(
            "tracks", [{**thing, "center": [0.0, thing["center"][1], 1.0]}], finish=(0.0, 7.0), moving=[trolley]
        )
        loose = Loose(scene)
        pushed_to(loose, 0, (float(rng.uniform(-2.0, 2.0)), 6.0))
        for time in np.arange(4.0, 20.0, 0.1):
            assert clear_of(loose.things[0], scene, float(time)), f"at {time}"


def clear_of(thing: Thing, scene: Scene, time: float) -> bool:
    """Whether the only box that moves is no farther in a thing than its skin."""
    moving = scene.obstacles.moving
    (center,), (yaw,) = (poses[0] for poses in moving.poses(time))
    points = thing.center + surface_points(thing, np.random.default_rng(5), 2000)
    own = quaternion.rotate(quaternion.about_axis(1, np.array([-yaw]))[0], points - center)
    return bool((depth_in(moving.tracks[0].shape, own) < 0.012).all())
