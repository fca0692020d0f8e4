"""Two avatars who see each other coming."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.others.prediction import slimmer
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.planning.command import Command
from elbowroom.world.obstacles.rows import corners_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
MODEL = body_model(AVATAR)
DT = 1 / 60
FORWARD = Command(forward=1.0)


def corridor() -> Scene:
    walls = [{"type": "box", "center": [side * 1.2, 1.1, 3.0], "size": [0.2, 2.2, 9.0]} for side in (-1, 1)]
    return Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": walls})


def capsules(frame: Frame) -> Floats:
    ends: Floats = posture_capsules(MODEL, frame.q[None], frame.root[None])[:, :, 0].astype(np.float64)
    return ends


def gap(ours: Floats, theirs: Floats) -> float:
    """The least distance between the surfaces of two sets of capsules (C, 6), by dense samples of one's axes."""
    parts = np.linspace(0.0, 1.0, 33)[:, None]
    points = ours[:, None, :3] + parts * (ours[:, None, 3:] - ours[:, None, :3])
    start, way = theirs[:, :3], theirs[:, 3:] - theirs[:, :3]
    from_start = points[:, :, None] - start
    along = np.clip(np.sum(from_start * way, axis=-1) / np.maximum(np.sum(way * way, axis=-1), 1e-12), 0.0, 1.0)
    away = np.linalg.norm(from_start - along[..., None] * way, axis=-1)
    radii = AVATAR.capsules.radii
    return float((away - radii[:, None, None] - radii).min())


def test_a_prediction_holds_the_avatar_now_and_moves_as_it_walks() -> None:
    controller = Controller(AVATAR, Scene.load("empty"), planner="exact")
    for _ in range(60):
        frame = controller.step(FORWARD, DT)
    told = controller.prediction().boxes
    boxes, (centers, _) = told.at(frame.time), told.poses(frame.time)
    ends = capsules(frame).reshape(-1, 2, 3)
    low = (ends - AVATAR.capsules.radii[:, None, None]).min(axis=(0, 1))
    high = (ends + AVATAR.capsules.radii[:, None, None]).max(axis=(0, 1))
    corners = corners_of(boxes).reshape(-1, 3)
    assert np.all(corners.min(axis=0) <= low)
    assert np.all(corners.max(axis=0) >= high)
    later, _ = told.poses(frame.time + 1.0)
    np.testing.assert_allclose(later[0, :, 2] - centers[0, :, 2], 1.1, atol=0.05)


def meeting(seconds: float, left: tuple[float, float] = (0.0, 0.0), late: float = 0.0) -> tuple[float, float, int]:
    """Two who walk towards each other in a corridor, each told of the other, `left` of its middle as seen by the first.

    How far each has come, metres; the second sets out `late` seconds after the first. And the turns in which the first
    walked slowly.
    """
    one = Controller(AVATAR, corridor(), planner="exact", seed=1, start=RootState(left[0], 0.0, 0.0))
    two = Controller(AVATAR, corridor(), planner="exact", seed=2, start=RootState(left[1], 6.0, np.pi))
    slow = 0
    for turn in range(round(seconds / DT)):
        ahead, towards = one.prediction(), two.prediction()
        one.others, two.others = (towards,), (ahead,)
        mine, yours = one.step(FORWARD, DT), two.step(FORWARD if turn * DT >= late else Command(), DT)
        assert not mine.touching
        assert not yours.touching
        if abs(mine.root[1] - yours.root[1]) < 1.0:
            assert gap(capsules(mine), capsules(yours)) > 0.0
        slow += bool(turn * DT > 1.0 and mine.root[3] < 0.9)
        if mine.root[1] > 4.0 and yours.root[1] < 2.0:
            break
    return float(mine.root[1]), 6.0 - float(yours.root[1]), slow


@pytest.mark.long
def test_two_who_walk_towards_each_other_in_a_corridor_pass_without_slowing_down() -> None:
    mine, yours, slow = meeting(6.0, (0.0, 0.1))
    assert mine > 4.0
    assert yours > 4.0
    assert slow < 6


@pytest.mark.long
@pytest.mark.parametrize("left", [(0.0, 0.0), (0.1, 0.0), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25), (0.4, 0.4)])
@pytest.mark.parametrize("late", [0.0, 1.5])
def test_wherever_two_meet_they_pass(left: tuple[float, float], late: float) -> None:
    mine, yours, _ = meeting(14.0, left, late)
    assert mine > 4.0
    assert yours > 4.0


def test_whether_bodies_touch_is_what_a_slow_judge_says() -> None:
    rng = np.random.default_rng(4)
    one = Controller(AVATAR, Scene.load("empty"), planner="exact")
    check, touching = BodyCheck(AVATAR, Scene.load("empty")), 0
    for _ in range(40):
        place = RootState(float(rng.uniform(0.0, 0.8)), float(rng.uniform(-0.3, 0.3)), float(rng.uniform(-3.0, 3.0)))
        two = Controller(AVATAR, Scene.load("empty"), planner="exact", start=place)
        check.others = (two.prediction(),)
        mine, yours = one.step(Command(), 0.0), two.step(Command(), 0.0)
        said = check.shown_clearance(mine.root, mine.q[3:], 0.0)
        judged = gap(capsules(mine), capsules(yours))
        assert said == pytest.approx(judged, abs=2e-3)  # a judge who samples finds a little more
        touching += said < 0.0
    assert 5 < touching < 35


def test_a_neighbours_body_goes_where_it_is_shown_next() -> None:
    controller = Controller(AVATAR, Scene.load("d"), planner="exact")
    for _ in range(90):
        controller.step(FORWARD, DT)
    told, shown = controller.prediction(), []
    for _ in range(6):
        frame = controller.step(FORWARD, DT)
        shown.append((frame.time, capsules(frame)))
    for time, axes in shown:
        np.testing.assert_allclose(told.at(time), axes, atol=2e-3)
    np.testing.assert_array_equal(told.at(-1.0), told.axes[0])
    np.testing.assert_array_equal(told.at(told.times[-1] + 5.0), told.axes[-1])


def test_who_means_to_walk_into_another_is_the_one_that_stops() -> None:
    """One stands; the other's plan, made without a word of the first, leads through there."""
    one = Controller(AVATAR, Scene.load("empty"), planner="exact", start=RootState(0.0, 1.5, np.pi))
    two = Controller(AVATAR, Scene.load("empty"), planner="exact")
    for _ in range(round(1.5 / DT)):
        told = two.prediction()
        walked = two.step(FORWARD, DT)
        if gap(capsules(one.step(Command(), 0.0)), capsules(walked)) < 0.06:
            break
    one.others, two.others = (told,), (one.prediction(),)
    for _ in range(30):
        frame = two.step(FORWARD, DT)
        assert not frame.touching
        assert not one.step(Command(), DT).touching
        assert gap(capsules(one.step(Command(), 0.0)), capsules(frame)) > 0.0
        one.others, two.others = (two.prediction(),), (one.prediction(),)


def test_who_touches_another_takes_it_to_be_smaller() -> None:
    controller = Controller(AVATAR, Scene.load("empty"), planner="exact")
    told = controller.prediction().boxes
    less = slimmer(told, 0.05)
    assert less.names == told.names
    np.testing.assert_allclose(told.half_sizes - less.half_sizes, np.tile([0.05, 0.0, 0.05], (len(told), 1)), atol=1e-9)
    assert np.all(slimmer(told, 5.0).half_sizes > 0.0)


@pytest.mark.parametrize(("ahead", "left"), [(0.7, 0.0), (0.7, 0.1), (0.9, -0.2)])
def test_who_stands_before_another_who_stays_there_walks_round(ahead: float, left: float) -> None:
    one = Controller(AVATAR, corridor(), planner="exact", seed=1)
    two = Controller(AVATAR, corridor(), planner="exact", seed=2, start=RootState(left, ahead, np.pi))
    one.others = (two.prediction(),)
    frames = []
    for _ in range(round(5.0 / DT)):
        frames.append(one.step(FORWARD, DT))
        if one.root.z > ahead + 1.0:
            break
    assert one.root.z > ahead + 1.0
    assert not any(frame.touching for frame in frames)
