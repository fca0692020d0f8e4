"""Walks over ground that is not a plane, straight on and judged by coal: sills, kerbs, ramps and stairs."""

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from elbowroom.body.gait.foot_state import standing
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE, RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.verdict import judge
from elbowroom.experiment.motion.stance import stretches
from elbowroom.planning.command import Command
from elbowroom.world.ground.ground import height_along
from elbowroom.world.scene import Scene
from feet_walks import in_world
from sampled import sampled

AVATAR = Humanoid.default()
FORWARD = Command(forward=1.0)
WIDE = 1.8  # metres between the walls
WALLS = [{"type": "box", "center": [side, 1.2, 4.0], "size": [0.2, 2.4, 12.0]} for side in (-1.0, 1.0)]


def box(begin: float, top: float, length: float) -> dict[str, Any]:
    return {"type": "box", "center": [0.0, 0.5 * top, begin + 0.5 * length], "size": [WIDE, top, length]}


def ramp(degrees: float, run: float = 2.0) -> list[dict[str, Any]]:
    top, half = math.tan(math.radians(degrees)) * run, 0.5 * WIDE
    points = [[x, y, z] for x in (-half, half) for y, z in ((0.0, 0.0), (0.0, run), (top, run))]
    return [{"type": "hull", "points": points, "center": [0.0, 0.0, 2.0]}, box(2.0 + run, top, 3.0)]


def stair(rise: float, tread: float, steps: int) -> list[dict[str, Any]]:
    treads = [box(2.0 + tread * i, rise * (i + 1), tread) for i in range(steps)]
    return [*treads, box(2.0 + tread * steps, rise * steps, 4.0)]


PLACES: dict[str, list[dict[str, Any]]] = {
    **{f"a sill of {height} cm": [box(3.0, 0.01 * height, 0.1)] for height in (1, 5, 10, 20)},
    "a kerb": [box(2.5, 0.15, 2.0)],
    "a ramp of 15 degrees": ramp(15.0),
    "a long ramp of 18.6 degrees": ramp(18.6, 4.0),
    "a stair of 17 by 28 cm": stair(0.17, 0.28, 4),
}
LONG = "a sill of 1 cm", "a sill of 5 cm", "a sill of 10 cm", "a long ramp of 18.6 degrees"  # the others are like these
SLOWLY_JUDGED = "a ramp of 15 degrees"


def names(*long: str) -> list[Any]:
    """All places; these in the long tests only."""
    return [pytest.param(name, marks=pytest.mark.long) if name in long else name for name in PLACES]


LONGEST = {
    "a ramp of 15 degrees": 12.0,
    "a long ramp of 18.6 degrees": 14.0,
    "a stair of 17 by 28 cm": 20.0,
}  # seconds; of all others 9


def scene_of(name: str) -> Scene:
    return Scene.of("ground", [*WALLS, *PLACES[name]], finish=(0.0, 6.5))


@cache
def walked(name: str) -> list[Frame]:
    scene = scene_of(name)
    controller, frames = Controller(AVATAR, scene), list[Frame]()
    while not scene.finished(controller.root) and len(frames) < 60 * LONGEST.get(name, 9.0):
        frames.append(controller.step(FORWARD, 1 / 60))
    return frames


def roots_of(name: str) -> np.ndarray:
    return np.stack([frame.root for frame in walked(name)])


@pytest.mark.parametrize("name", names(*LONG))
def test_it_is_crossed_straight_and_in_time(name: str) -> None:
    scene, roots = scene_of(name), roots_of(name)
    assert scene.finished(RootState.of(roots[-1]))
    assert not any(frame.touching for frame in walked(name))
    assert np.diff(roots[roots[:, 1] < 1.0, 1]).min() > -1e-3, "nobody steps back from what is far ahead"
    assert np.abs(roots[:, 0]).max() < (0.3 if "stair" in name else 0.02)


@pytest.mark.parametrize("name", sampled(PLACES, ["a kerb"]))
def test_another_library_finds_nothing_touched_but_the_ground_under_soles(name: str) -> None:
    motion = ShownMotion.at_rate(np.stack([frame.q for frame in walked(name)]), roots_of(name))
    verdict = judge(motion, AVATAR, scene_of(name))
    assert verdict.clean, (verdict.capsules.contacts[:3], verdict.mesh and verdict.mesh.contacts[:3])
    assert verdict.itself.touching == 0


@pytest.mark.parametrize("name", names(*LONG))
def test_the_root_follows_the_ground_and_no_foot_is_under_it(name: str) -> None:
    ground, roots = scene_of(name).ground, roots_of(name)
    below, height = [], 0.0
    for x, z in roots[:, :2].tolist():
        height = height_along(ground, (x, height, z - 0.02), x, z)
        below.append(height)
    assert np.abs(roots[:, HEIGHT] - below).max() < 0.22
    assert abs(roots[-1, HEIGHT] - below[-1]) < 0.01
    assert np.abs(np.diff(roots[:, HEIGHT])).max() < 0.02, "it does not jump"
    soles = roots[:, HEIGHT, None] + roots[:, [RISES, RISES + 2]]
    assert soles.min() > -1e-6
    jumps = np.abs(np.diff(soles, axis=0)).max(axis=1) > 4.0 / 60 + 1e-9
    assert jumps.sum() <= 1, "feet are raised as fast as they are lifted, but where that touches"


@pytest.mark.parametrize("name", names(*LONG, SLOWLY_JUDGED))
def test_a_foot_that_stands_keeps_its_place_and_what_it_stands_on(name: str) -> None:
    """But for one stance, where no step is clear of the treads; and it may come down a little later than it stands."""
    rows, slid, sunk = roots_of(name), [], []
    for side in range(2):
        places, heights = in_world(rows, side)[:, :2], rows[:, HEIGHT] + rows[:, RISES + 2 * side]
        for stance in stretches(standing(rows)[:, side]):
            slid.append(float(np.linalg.norm(places[stance] - places[stance.start], axis=1).max()))
            sunk.append(float(np.ptp(heights[stance][-len(heights[stance]) // 2 :])))
    assert np.sort(slid)[-2] < 5e-3
    assert np.sort(sunk)[-2] < 5e-3
    assert np.median(slid) < 1e-9


def test_on_the_plane_nothing_rises() -> None:
    controller = Controller(AVATAR, Scene.load("d"))
    roots = np.stack([controller.step(FORWARD, 1 / 60).root for _ in range(60)])
    assert not roots[:, HEIGHT:ROOT_STATE].any()
