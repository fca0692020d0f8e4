"""Who is held in mid-stride by a stop that came late gets away again: lower, or with arms beside the legs."""

import random
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.clips.motion_set import STOCK
from elbowroom.control.controller import Controller
from elbowroom.control.key_frame_queue import Playback
from elbowroom.control.plans.canned import standing_posture
from elbowroom.control.plans.planning_scene import PlanningScene
from elbowroom.control.settings import ControlSettings
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.control.shown.showing import Showing
from elbowroom.experiment.gauntlet.scenes import course_scene
from elbowroom.planning.command import Command
from elbowroom.planning.names import DEFAULT_PLANNER
from elbowroom.planning.root.pace import at_speed
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
ONE_TURN = 1 / 60  # seconds
LOW = 1.75  # metres: so near that it is measured
IMPATIENT, PATIENCE = 1.0, 10.0  # seconds


def longest_wait(scene: Scene, seed: int, seconds: float) -> float:
    """Seconds that a walker was stuck on end whose user holds the key, lets go and holds it again, at random."""
    chance = random.Random(seed)
    controller = Controller(Humanoid.default(), scene, seed=0)
    speed, until, command, time, waited, longest = chance.uniform(0.8, 1.7), 0.0, Command(), 0.0, 0.0, 0.0
    while time < seconds and not scene.finished(controller.root):
        if time >= until:
            stop = chance.random() < 0.35
            until = time + (chance.uniform(0.1, 0.8) if stop else chance.uniform(0.3, 2.0))
            share = 0.0 if stop else chance.choice([1.0, 1.0, chance.uniform(0.3, 1.0)])
            if waited > IMPATIENT:
                share, until = 1.0, time + PATIENCE
            command = Command(forward=share, direction=0.0 if share else None)
        frame = controller.step(at_speed(command, speed), ONE_TURN)
        assert frame.clearance >= 0.0
        time += ONE_TURN
        waited = waited + ONE_TURN if frame.stuck else 0.0
        longest = max(longest, waited)
        if longest >= PATIENCE:
            break
    return longest


def standing_under(slab: float) -> Showing:
    """One who stands so many metres under a slab."""
    humanoid, root = Humanoid.default(), np.zeros(ROOT_STATE)
    crown = BodyCheck(humanoid, Scene.of("sky", [ceiling(LOW)], finish=(0.0, 5.0)))
    height = LOW - crown.clearance(root, standing_posture(root), 0.0)
    scene = Scene.of("slab", [ceiling(height + slab)], finish=(0.0, 5.0))
    around = PlanningScene(humanoid, scene, ControlSettings(DEFAULT_PLANNER, 5, 0.15, 0, True), STOCK)
    return Showing(around, root, assist=True)


def ceiling(height: float) -> dict[str, object]:
    return {"type": "box", "center": [0.0, height + 0.1, 0.0], "size": [2.0, 0.2, 2.0]}


def stopped_in_stride(showing: Showing) -> Floats:
    """The root state, at 1 m/s, in which one is shown from now on."""
    root = showing.pose.root.copy()
    root[3] = 1.0
    showing._pose = showing.pose._replace(root=root)
    return root


def test_where_nothing_else_is_free_one_is_held_to_the_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who has no room to stand in would go into the knees: not unless that is free."""
    showing = standing_under(0.005)
    shown = showing.pose
    monkeypatch.setattr(Showing, "_is_free", lambda *_: False)
    showing.hold(ONE_TURN, ONE_TURN)
    assert np.array_equal(showing.pose.root, shown.root)
    assert np.array_equal(showing.pose.upper, shown.upper)


def test_who_is_held_and_stands_costs_no_more_than_who_rests(monkeypatch: pytest.MonkeyPatch) -> None:
    """No step is made for legs that stand, and what breathes is looked at in every other frame.

    In the first one it is looked whether arms make way for the legs.
    """
    showing, looked = standing_under(0.5), list[float]()
    showing.hold(ONE_TURN, ONE_TURN)
    clearance_of = Showing._clearance_of

    def counted(self: Showing, root: Floats, upper: Floats) -> float:
        looked.append(self._now)
        return clearance_of(self, root, upper)

    def no_step(*_: object) -> None:
        pytest.fail("feet follow though they stand")

    monkeypatch.setattr(Showing, "_clearance_of", counted)
    monkeypatch.setattr("elbowroom.control.feet.stepping.followed", no_step)
    for turn in range(2, 62):
        showing.hold(turn * ONE_TURN, ONE_TURN)
    assert 0 < len(looked) <= 30
    assert showing.holding.active


@pytest.mark.parametrize(("seconds", "most"), [(ONE_TURN, 3), (0.5 * ONE_TURN, 2)])
def test_what_was_not_free_is_not_tried_again_in_each_frame(
    monkeypatch: pytest.MonkeyPatch, seconds: float, most: int
) -> None:
    """One who is held in a stride, and none of whose ways to stand is free; in another pose it is tried at once."""
    showing, tried = standing_under(0.5), set[float]()

    def never_free(self: Showing, *_: object) -> bool:
        tried.add(self._now)
        return False

    monkeypatch.setattr(Showing, "_is_free", never_free)
    in_stride = stopped_in_stride(showing)
    for turn in range(1, 13):
        showing.hold(turn * seconds, seconds)
        assert showing.pose.root is in_stride
    assert 1 <= len(tried) <= most
    showing._show(showing.pose._replace(root=in_stride.copy()), showing.clearance)
    showing.hold(13 * seconds, seconds)
    assert 13 * seconds in tried


@pytest.mark.parametrize(("has", "offered", "keeps"), [(9.0, 1.9, False), (9.0, 2.1, True), (1.0, 0.9, False)])
def test_legs_come_to_a_stand_where_that_leaves_a_motion_room_to_begin(
    monkeypatch: pytest.MonkeyPatch, has: float, offered: float, keeps: bool
) -> None:
    """Millimetres that one who is held has about the body, and that it would have with its legs nearer to a stand."""
    showing = standing_under(0.001 * has)
    stopped_in_stride(showing)
    nearer = showing.pose._replace(upper=showing.pose.upper + 1e-3)

    def settling(_: Showing, dt: float) -> Iterator[Playback]:
        yield nearer

    monkeypatch.setattr(Showing, "_settling", settling)
    monkeypatch.setattr(Showing, "_is_free", lambda *_: True)
    monkeypatch.setattr(Showing, "_clearance_of", lambda *_: 0.001 * offered)
    showing.hold(ONE_TURN, ONE_TURN)
    assert np.array_equal(showing.pose.upper, nearer.upper) == keeps


@pytest.mark.long
@pytest.mark.parametrize(("course", "seed", "seconds"), [(10, 3, 6.0), (7, 0, 9.0), (8, 0, 9.0)])
def test_who_is_held_in_a_stride_gets_away(course: int, seed: int, seconds: float) -> None:
    assert longest_wait(course_scene(f"gauntlet:5:{course}"), seed, seconds) < 2.0


@pytest.mark.long
@pytest.mark.parametrize("course", range(100, 110))
@pytest.mark.parametrize("seed", range(3))
def test_nobody_who_stops_and_goes_is_stuck_for_good(course: int, seed: int) -> None:
    assert longest_wait(course_scene(f"gauntlet:5:{course}"), seed, 40.0) < PATIENCE


@pytest.mark.long
def test_who_finds_no_way_on_past_a_beam_comes_to_a_stand_as_gently_as_ever() -> None:
    """A way round ends in the walk: where it is not made longer in time, it is braked, not broken off."""
    controller, places = (
        Controller(Humanoid.default(), course_scene("gauntlet:4:91057"), seed=0),
        list[tuple[float, float]](),
    )
    while len(places) < 60 * 9.2:
        root = controller.step(at_speed(Command(forward=1.0, direction=0.0), 1.1), ONE_TURN).root
        places.append((float(root[0]), float(root[1])))
    changes = np.linalg.norm(np.diff(np.array(places), 2, axis=0), axis=1) / ONE_TURN**2
    assert changes.max() <= 1.01 * RootMotionSettings().braking
