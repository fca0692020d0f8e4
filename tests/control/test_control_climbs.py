"""What is too high for a step is climbed where there is no way round, and only there; judged by coal and the mesh."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.journey import JourneyState
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.control.recordings.replay import replay
from elbowroom.errors import InputError
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.planning.model.highest_step import CLIMB, as_climbed, highest_climb, highest_step
from elbowroom.world.ground.ground import STEP
from elbowroom.world.scene import Scene
from late_desk import LateDesk
from sampled import sampled

AVATAR = Humanoid.default()
FORWARD, STAND = Command(forward=1.0), Command()
FRAME = 1 / 60
BEGIN, BEYOND = 2.0, 1.0  # metres: where what is climbed begins, and how far behind it the walk ends


def box(top: float, length: float, *, wide: float = 1.8, name: str = "block") -> dict[str, Any]:
    center = [0.0, 0.5 * top, BEGIN + 0.5 * length]
    return {"type": "box", "name": name, "center": center, "size": [wide, top, length]}


def corridor(length: float) -> list[dict[str, Any]]:
    size = [0.2, 2.4, length]
    return [{"type": "box", "center": [side, 1.2, 0.5 * length - 2.0], "size": size} for side in (-1.0, 1.0)]


def across(top: float, length: float) -> Scene:
    return Scene.of("across", [*corridor(10.0), box(top, length)], finish=(0.0, BEGIN + length + BEYOND))


def walked(scene: Scene, seconds: float = 14.0, *, aside: float = 0.0) -> list[Frame]:
    start = scene.start._replace(z=scene.start.z + aside)
    controller, frames = Controller(AVATAR, scene, start=start), list[Frame]()
    while not scene.finished(controller.root) and len(frames) < seconds / FRAME:
        frames.append(controller.step(FORWARD, FRAME))
    return frames


@cache
def over(top: float, length: float) -> list[Frame]:
    return walked(across(top, length))


def heights(frames: list[Frame]) -> "np.ndarray[tuple[int], np.dtype[np.float64]]":
    return np.array([frame.root[HEIGHT] for frame in frames])


QUICKEST = 6.0  # m/s, up or down: 10 cm in a frame
PLACES = [(0.4, 0.1), (0.3, 0.1), (0.4, 0.5), (0.3, 2.0), (0.4, 2.0)]  # heights and lengths, metres


@pytest.mark.parametrize(("top", "length"), sampled(PLACES))
def test_what_lies_across_a_corridor_is_climbed(top: float, length: float) -> None:
    frames = over(top, length)
    assert frames[-1].root[1] >= BEGIN + length + BEYOND - 0.02
    assert not any(frame.stuck for frame in frames)
    assert heights(frames).max() > 0.2 * top
    assert abs(heights(frames)[-1]) < 1e-6
    assert frames[-1].root[3] > 0.8, "behind it one walks on as fast as before"


@pytest.mark.parametrize(("top", "length"), [(0.3, 0.1), (0.4, 0.1)])
@pytest.mark.parametrize("aside", [0.0, 0.13])
def test_a_foot_that_is_close_before_an_edge_goes_up_and_is_nowhere_at_once(
    top: float, length: float, aside: float
) -> None:
    frames = walked(across(top, length), aside=aside) if aside > 0.0 else over(top, length)
    roots = np.stack([frame.root for frame in frames])
    heights_of_feet = roots[:, RISES:ROOT_STATE:2] + roots[:, [HEIGHT]]
    assert np.abs(np.diff(heights_of_feet, axis=0)).max() < QUICKEST * FRAME


@pytest.mark.parametrize(("top", "length"), sampled(PLACES))
@pytest.mark.parametrize("aside", sampled([0.0, 0.13, 0.26]))
def test_another_library_finds_nothing_touched_in_a_climb(top: float, length: float, aside: float) -> None:
    scene = across(top, length)
    frames = walked(scene, aside=aside) if aside > 0.0 else over(top, length)
    motion = ShownMotion.at_rate(np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames]))
    verdict = judge(motion, AVATAR, scene)
    assert verdict.clean, (verdict.capsules.contacts[:3], verdict.mesh and verdict.mesh.contacts[:3])
    assert verdict.itself.touching == 0


@pytest.mark.parametrize(("late", "aside"), sampled([(5, 0.3), (12, 0.1), (12, 0.7)]))
def test_nobody_is_stuck_before_it_is_decided_whether_to_climb(late: int, aside: float) -> None:
    """Plans that come late: one stands for a moment before the next one tells."""
    scene, desk = across(0.4, 2.0), LateDesk(late)
    start = scene.start._replace(z=scene.start.z + aside)
    controller = Controller(AVATAR, scene, start=start, ahead=Lookahead(desk=desk))
    for _ in range(8 * 60):
        desk.next_turn()
        frame = controller.step(FORWARD, FRAME)
        assert not frame.stuck
        if frame.root[HEIGHT] > 0.0:
            return
    pytest.fail("it has not climbed")


def test_what_is_higher_than_a_knee_is_stood_before() -> None:
    frames = walked(across(0.5, 0.1), 6.0)
    assert frames[-1].stuck
    assert np.abs(heights(frames)).max() < 1e-6


def test_nobody_climbs_where_there_is_a_way_round() -> None:
    scene = Scene.of("round", [box(0.4, 0.4, wide=0.7)], finish=(0.0, 5.0))
    frames = walked(scene)
    assert frames[-1].root[1] > 4.9
    assert np.abs(heights(frames)).max() < 1e-6
    assert not any(frame.stuck for frame in frames)


@pytest.mark.long
def test_who_halts_on_top_goes_on_and_down_again_by_either_side() -> None:
    for back in (1.0, -1.0):
        controller = Controller(AVATAR, across(0.4, 2.0))
        while controller.root.z < BEGIN + 1.0:
            controller.step(FORWARD, FRAME)
        top = [controller.step(STAND, FRAME) for _ in range(120)][-1]
        assert top.root[HEIGHT] == pytest.approx(0.4, abs=1e-6)
        frames = [controller.step(Command(forward=back), FRAME) for _ in range(480)]
        assert abs(frames[-1].root[HEIGHT]) < 1e-6
        assert not any(frame.touching for frame in frames)


def test_reset_in_a_climb_is_as_if_newly_made() -> None:
    controller = Controller(AVATAR, across(0.4, 0.1))
    while controller.root.height < 0.05:
        controller.step(FORWARD, FRAME)
    controller.reset()
    again = [controller.step(FORWARD, FRAME) for _ in range(120)]
    for frame, before in zip(again, over(0.4, 0.1), strict=False):
        assert np.array_equal(frame.q, before.q)
        assert np.array_equal(frame.root, before.root)


def test_a_climb_is_recorded_and_played_again_bit_for_bit(tmp_path: Path) -> None:
    scene, file = across(0.4, 0.1), tmp_path / "climb.elbow"
    controller = Controller(AVATAR, scene)
    with Recorder(file, controller) as recorder:
        while not scene.finished(controller.root):
            recorder.append(controller.step(FORWARD, FRAME), FRAME)
    assert replay(Recording(file), AVATAR).identical


# --- going to a place ----------------------------------------------------------------------------------------------


def room(top: float) -> Scene:
    """A closed corridor with something across it."""
    ends = [{"type": "box", "center": [0.0, 1.2, z], "size": [2.2, 2.4, 0.2]} for z in (-1.2, 5.2)]
    walls = [{"type": "box", "center": [side, 1.2, 2.0], "size": [0.2, 2.4, 6.6]} for side in (-1.0, 1.0)]
    return Scene.of("room", [*ends, *walls, box(top, 0.3)], finish=(0.0, 4.0))


@pytest.mark.long
def test_a_way_leads_over_what_is_climbed_where_there_is_no_other() -> None:
    controller = Controller(AVATAR, room(0.4))
    journey = controller.goto((0.0, 4.0))
    assert journey.way.climbs
    frames = list[Frame]()
    while journey.walking and len(frames) < 20.0 / FRAME:
        frames.append(controller.step(STAND, FRAME))
    assert journey.state is JourneyState.ARRIVED, journey.reason
    assert not any(frame.touching for frame in frames)


def test_ways_that_are_walked_come_first_and_what_is_too_high_is_no_way() -> None:
    assert not Controller(AVATAR, room(0.2)).goto((0.0, 4.0)).way.climbs
    with pytest.raises(InputError, match="no way leads"):
        Controller(AVATAR, room(0.6)).goto((0.0, 4.0))


# --- whom and what -------------------------------------------------------------------------------------------------


def test_the_height_of_a_climb_is_the_body_s() -> None:
    assert highest_step(AVATAR) == STEP
    assert STEP < highest_climb(AVATAR) <= CLIMB
    scene = across(0.4, 0.1)
    assert as_climbed(scene, AVATAR) is as_climbed(scene, AVATAR), "one for all"
    assert as_climbed(Scene.load("empty"), AVATAR) is None
    assert as_climbed(across(0.6, 0.1), AVATAR) is None


def test_what_somebody_stands_on_is_not_pushed() -> None:
    crate = box(0.4, 0.9, wide=1.7, name="crate")
    scene = Scene.of("crate", [*corridor(10.0), crate], finish=(0.0, 6.0))
    controller = Controller(AVATAR, scene)
    while controller.root.z < BEGIN + 0.45:
        controller.step(FORWARD, FRAME)
    with pytest.raises(InputError, match="obstacle crate of scene crate: the avatar stands on it"):
        controller.push(2, (0.0, 5.0))
    assert not controller.things
    frames = [controller.step(FORWARD, FRAME) for _ in range(240)]
    assert not any(frame.touching for frame in frames)
    assert frames[-1].root[1] > BEGIN + 1.5
