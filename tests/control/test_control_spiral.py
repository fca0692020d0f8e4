"""A spiral stair of open treads that taper, with a gap before the floor: walked up and down, judged by coal."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.journey import JourneyState
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from stairs import BEFORE, ON_FLOOR, TREADS, spiral_stair, tread_top

pytestmark = pytest.mark.long
AVATAR = Humanoid.default()
TOP = tread_top(TREADS)
LONGEST = 90.0  # seconds


def scene_of(up: bool) -> Scene:
    scene = spiral_stair()
    return scene if up else replace(scene, start=RootState(x=ON_FLOOR[0], z=ON_FLOOR[1], height=TOP))


@cache
def walked(up: bool) -> tuple[JourneyState, list[Frame]]:
    controller, frames = Controller(AVATAR, scene_of(up)), list[Frame]()
    controller.goto((ON_FLOOR[0], TOP, ON_FLOOR[1]) if up else (BEFORE[0], 0.0, BEFORE[1]))
    assert controller.journey is not None
    while controller.journey.walking and len(frames) < 60 * LONGEST:
        frames.append(controller.step(Command(), 1 / 60))
    return controller.journey.state, frames


@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
def test_one_arrives(up: bool) -> None:
    state, frames = walked(up)
    assert state is JourneyState.ARRIVED
    assert RootState.of(frames[-1].root).height == pytest.approx(TOP if up else 0.0, abs=0.01)


@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
def test_another_library_finds_nothing_touched_but_the_treads_under_soles(up: bool) -> None:
    _, frames = walked(up)
    motion = ShownMotion.at_rate(np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames]))
    verdict = judge(motion, AVATAR, scene_of(up))
    assert verdict.clean, (verdict.capsules.contacts[:3], verdict.mesh and verdict.mesh.contacts[:3])
    assert verdict.itself.touching == 0


def test_nobody_stays_in_mid_stride_where_a_spiral_leads_under_a_slab() -> None:
    """Who wants to go on there comes to a stand or goes back, and touches nothing."""
    controller, (x, z) = Controller(AVATAR, spiral_stair(2.3)), BEFORE
    around = [math.radians(260.0 + 20.0 * k) for k in range(8)]
    way = ((x, z), *((0.6 * math.cos(angle), 0.6 * math.sin(angle)) for angle in around))
    command = Command(forward=1.0, direction=math.atan2(way[1][0] - x, way[1][1] - z), way=way)
    before, stays, longest = controller.root, 0.0, 0.0
    for _ in range(60 * 15):
        frame = controller.step(command, 1 / 60)
        assert not frame.touching
        root = RootState.of(frame.root)
        moves = math.hypot(root.x - before.x, root.z - before.z) > 1e-4 or max(map(abs, root[3:6])) < 1e-3
        before, stays = root, 0.0 if moves else stays + 1 / 60
        longest = max(longest, stays)
    assert longest < 2.0
    assert controller.root.height > 0.1, "it did not come to the stair"
