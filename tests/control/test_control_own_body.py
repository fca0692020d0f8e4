"""What is shown keeps out of itself: on feet that step as people's do, and all the way from one frame to the next."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, LOWERING, DofGroup, columns_of, limits
from elbowroom.body.gait.footholds import beside
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import CARRIAGE, FOOT, ROOT_STATE
from elbowroom.clips.motion_set import STOCK
from elbowroom.control.feet.arms_beside_legs import ArmsBesideLegs
from elbowroom.control.key_frame_queue import Playback
from elbowroom.control.plans.planning_scene import PlanningScene
from elbowroom.control.settings import ControlSettings
from elbowroom.control.shown.body_check import BodyCheck, Frames
from elbowroom.control.shown.own_body_check import own_body_check
from elbowroom.control.shown.showing import Showing
from elbowroom.dataset.draw import DrawnWalk
from elbowroom.dataset.spec import DatasetSpec
from elbowroom.dataset.walk import company_on, controller_of, setting_of, steps_of
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.names import DEFAULT_PLANNER
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Pose = tuple[Floats, Floats]

BODY = Humanoid.default()
MODEL = body_model(BODY)
CHECK, PAIRS = own_body_check(BODY, STOCK), self_pairs(MODEL)
ALONE = BodyCheck(BODY, Scene.load("empty"))
FRAME = 1 / 60  # seconds
BEND, LOWERED = columns_of(DofGroup.WAIST).start, LOWERING - DofGroup.ROOT.size
# Walks of a dataset in which parts of the body were deeper in each other than they may: a hand in a thigh that comes
# by, and the belly in a thigh of who goes aside in a crouch.
WALKS = [
    DrawnWalk("d", "stock", "strafing", 508671556, "stock", ()),
    DrawnWalk("c", "stock", "strafing", 1990636894, "style:old", ()),
]


def gap(pose: Pose) -> float:
    """How much nearer any part could come to another, metres."""
    root, upper = pose
    return float(self_clearances(MODEL, PAIRS, root[None], upper[None]).min())


def free_between(one: Pose, other: Pose) -> bool:
    return CHECK.free_between(ALONE.between(Frames((one[0], other[0]), (one[1], other[1]), (0.0, 1.0))))


def standing_alone() -> Showing:
    scene = Scene.of("nothing", [], finish=(0.0, 5.0))
    around = PlanningScene(BODY, scene, ControlSettings(DEFAULT_PLANNER, 5, 0.15, 0, True), STOCK)
    return Showing(around, np.zeros(ROOT_STATE), assist=True)


def posture(rng: np.random.Generator) -> Pose:
    """Feet apart, arms, trunk and head anywhere within their limits, and hips that are carried somehow."""
    root = np.append(beside(MODEL.gait, np.zeros(ROOT_STATE)), np.zeros(CARRIAGE))
    for side in range(2):
        root[ROOT_STATE + FOOT * side :][:3] += rng.uniform(-0.2, 0.2, 3)
    root[3:6], root[-CARRIAGE:-3] = rng.uniform(-0.5, 0.5, 3), rng.uniform(-0.05, 0.05, CARRIAGE - 3)
    upper = [rng.uniform(*limits(group).T) for group in LOCAL_GROUPS]
    return root, 0.7 * np.concatenate(upper)


def test_the_way_between_two_frames_is_free_where_no_part_comes_too_deep_into_another() -> None:
    """The naive twin looks at sixty moments between."""
    rng, found, shares = np.random.default_rng(0), [0, 0], np.linspace(0.0, 1.0, 60)[:, None]
    for _ in range(500):
        one, toward = posture(rng), posture(rng)
        if gap(one) < 1e-3:
            continue
        other = one[0] + 0.2 * (toward[0] - one[0]), one[1] + 0.2 * (toward[1] - one[1])
        rows, uppers = (before + shares * (after - before) for before, after in zip(one, other, strict=True))
        least = float(self_clearances(MODEL, PAIRS, rows, uppers).min())
        free = free_between(one, other)
        assert least >= 0.0 if free else least < 1e-3
        found[free] += 1
    assert min(found) > 8


def test_who_is_in_himself_may_come_out_but_not_go_deeper() -> None:
    root = np.append(beside(MODEL.gait, np.zeros(ROOT_STATE)), np.zeros(CARRIAGE))
    root[ROOT_STATE + 1], root[ROOT_STATE + 4] = 0.1, 0.2  # a foot ahead, and raised
    bends = np.linspace(0.0, 1.4, 8)
    poses = [(root, np.zeros(LOCAL)) for _ in bends]
    for (_, upper), bend in zip(poses, bends, strict=True):
        upper[BEND], upper[LOWERED] = bend, 0.6
    less, more = poses[-2], poses[-1]
    assert gap(more) < gap(less) < -0.01, "the trunk lies on the thighs"
    assert free_between(more, less)
    assert free_between(less, less)
    assert not free_between(less, more)
    assert not free_between(poses[0], more)


@pytest.mark.parametrize(
    ("component", "into"),
    [
        (columns_of(DofGroup.WAIST), (1.57, 0.0, 0.9)),
        (columns_of(DofGroup.RIGHT_ARM), (0.2, 0.0, 1.2, 1.6)),
    ],
)
def test_a_pose_with_parts_in_each_other_is_not_shown(component: slice, into: tuple[float, ...]) -> None:
    showing = standing_alone()
    shown, ahead = showing.pose, np.append(1.0, np.zeros(ROOT_STATE))[None]
    upper = shown.upper.copy()
    upper[component] = into
    assert gap((shown.root, upper)) < -0.003
    assert not showing.play(Playback(np.zeros(ROOT_STATE), upper, np.zeros(LOCAL)), ahead, FRAME, FRAME)
    assert showing.pose is shown
    assert showing.play(Playback(np.zeros(ROOT_STATE), shown.upper, np.zeros(LOCAL)), ahead, 2.0 * FRAME, FRAME)


def test_arms_are_spread_until_they_are_out_of_a_leg_that_stands_far_aside() -> None:
    """A hand before a thigh gets out of it little at first: three guesses at how far it has to go were too few."""
    arms, moved = ArmsBesideLegs(MODEL, STOCK), 0
    for ahead in np.linspace(-0.1, 0.2, 4):
        for aside in np.linspace(0.1, 0.45, 8):
            for flexion in np.linspace(-0.2, 0.6, 9):
                root, upper = beside(MODEL.gait, np.zeros(ROOT_STATE)), np.zeros(LOCAL)
                root[ROOT_STATE : ROOT_STATE + 2] += aside, ahead
                root[ROOT_STATE + 4] = 0.05
                upper[columns_of(DofGroup.LEFT_ARM)] = flexion, 0.05, 0.0, 0.1
                upper[columns_of(DofGroup.RIGHT_ARM)] = 0.0, 0.3, 0.0, 0.2
                apart = arms.apart(root, upper)
                assert arms.are_clear(root, apart)
                moved += apart is not upper
    assert moved > 50


def in_a_crouch(showing: Showing, forward: float, aside: float, phase: float) -> tuple[list[Pose], list[bool]]:
    """What is shown of who gets down and goes ahead and aside for two seconds, and what of it was as planned."""
    poses, played, upper = list[Pose](), list[bool](), showing.pose.upper.copy()
    going = np.zeros(ROOT_STATE)
    going[[0, 1, 6]] = aside, forward, 0.75
    for k in range(120):
        row, share = going * k * FRAME, min(k / 30, 1.0)
        row[3], row[4], row[6] = forward * share, aside * share, phase + row[6]
        ahead = np.array([np.append(after, row + after * going) for after in 0.15 * np.arange(1, 7)])
        upper = upper.copy()
        upper[BEND], upper[LOWERED] = 0.8 * share, 0.6 * share
        played.append(showing.play(Playback(row, upper, np.zeros(LOCAL)), ahead, (k + 1) * FRAME, FRAME))
        poses.append((showing.pose.root, showing.pose.upper))
    return poses, played


@pytest.mark.parametrize(("forward", "aside", "phase"), [(-0.3, 0.6, 0.0), (0.3, 0.6, 0.5), (0.6, 0.3, 0.0)])
def test_feet_glide_under_who_is_bent_over_thighs_that_would_come_up(
    forward: float, aside: float, phase: float
) -> None:
    """The walking cycle has room under the trunk, feet that step have none; hardly anybody is held."""
    poses, played = in_a_crouch(standing_alone(), forward, aside, phase)
    assert min(gap(pose) for pose in poses) > 0.0
    assert sum(played) >= 118


@pytest.mark.long
@pytest.mark.parametrize("number", range(len(WALKS)))
def test_who_is_steered_aside_keeps_out_of_himself(number: int) -> None:
    spec, drawn = DatasetSpec(seconds=3.5), WALKS[number]
    setting = setting_of(drawn)
    controller = controller_of(spec, drawn, setting)
    frames = [frame for _, frame in steps_of(spec, drawn, setting, controller, company_on(drawn, setting, controller))]
    motion = ShownMotion.at_rate(np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames]))
    verdict = judge(motion, setting.humanoid, setting.scene, JudgeSettings(mesh=False))
    assert verdict.itself.touching == verdict.capsules.touching == 0
