"""Feet of a recorded walk: found as they went, and shown so again on feet that stand."""

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, DofGroup
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.foot_state import standing
from elbowroom.body.gait.footholds import UNKNOWN, beside, onward
from elbowroom.body.gait.living import body_of
from elbowroom.body.gait.own_steps import CYCLE, KEYS, LIFT, PITCH, OwnSteps
from elbowroom.body.gait.own_stride import OwnStride
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.root import FOOT, ROOT_STATE
from elbowroom.clips.clip import Clip
from elbowroom.clips.motion_set import MotionSet
from elbowroom.clips.planning_motion import planning_motion
from elbowroom.clips.swing import Swing, swing_of
from elbowroom.errors import InputError
from elbowroom.experiment.motion.walked import posed
from feet_walks import DT, GAIT, WANTED, alive, in_world, path, random_wish, walked
from made_walk import captured
from shared_data import SHARED, needs_shared

Floats = NDArray[np.float64]

SPEED = 1.1  # m/s


def stepped(roots: Floats, own: OwnSteps) -> Floats:
    """Root states (frames, 7) with feet that go so."""
    rows = [beside(GAIT, roots[0])]
    for root in roots[1:]:
        rows.append(onward(GAIT, rows[-1], root, DT, UNKNOWN, own))
    return np.array(rows)


def even(speed: float = SPEED) -> Floats:
    return path(lambda _: (speed, 0.0, 0.0), 480)


def high_knees() -> OwnSteps:
    """Who lifts the feet high, turned out and wide apart, and stands short."""
    cycle, parts = np.zeros((2, 2 * KEYS + 1, 5)), np.linspace(0.0, 1.0, KEYS + 1)
    cycle[:, KEYS:, LIFT] = 0.25 * 16.0 * (parts * (1.0 - parts)) ** 2
    cycle[:, KEYS - 4 : KEYS + 5, PITCH] = 0.4 * np.sin(np.pi * np.linspace(0.0, 1.0, 9))
    return OwnSteps(SPEED, -0.04, np.array([[0.04, -0.05, 0.25], [0.04, -0.05, 0.25]]), cycle)


def seen_walking(rows: Floats) -> Swing:
    motion = captured(proportional_humanoid(), alive(rows)[180:], np.zeros((len(rows) - 180, LOCAL)))
    return swing_of(planning_motion(motion), "made")


@pytest.mark.parametrize("own", [CYCLE, high_knees()], ids=["published", "high knees"])
def test_feet_go_as_they_were_seen(own: OwnSteps) -> None:
    seen = stepped(even(), own)
    swing = seen_walking(seen)
    shown = stepped(even(), swing.steps._replace(speed=SPEED))
    for side in range(2):
        before, after = (rows[300:, ROOT_STATE + FOOT * side :][:, :5] for rows in (seen, shown))
        for column, most in enumerate((0.02, 0.05, 0.06, 0.15, 0.025)):
            assert np.sqrt(np.mean((after - before)[:, column] ** 2)) < most, column
    assert standing(shown[180:]).mean() == pytest.approx(standing(seen[180:]).mean(), abs=0.04)


def test_a_standing_foot_does_not_move_whoever_walks() -> None:
    for wanted in [*WANTED.values(), *(random_wish(seed) for seed in range(4))]:
        rows = stepped(path(wanted), high_knees())
        stands = standing(rows)
        for side in range(2):
            stays = stands[1:, side] & stands[:-1, side]
            assert np.abs(np.diff(in_world(rows, side), axis=0)[stays]).max() < 1e-12
        assert stands.any(axis=1).all()


def test_own_steps_do_not_jump_and_rest_as_all_do() -> None:
    for wanted in WANTED.values():
        rows = stepped(path(wanted, 360), high_knees())
        feet, _ = posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, rows, np.zeros(len(rows)))
        roots = np.linalg.norm(np.diff(rows[:, :2], axis=0), axis=1)
        steps = np.linalg.norm(np.diff(feet[:, :, :3], axis=0), axis=2) - roots[:, None]
        assert steps.max() < 8.0 * DT
        np.testing.assert_allclose(rows[-1, ROOT_STATE:], walked(path(wanted, 360))[-1, ROOT_STATE:], atol=0.03)


def test_recordings_keep_the_legs() -> None:
    swing = seen_walking(stepped(even(), high_knees()))
    written = json.loads(json.dumps(MotionSet(swing).to_dict()))
    read = MotionSet.from_dict(written, "a.elbow").own_steps
    for name in OwnSteps._fields:
        np.testing.assert_array_equal(getattr(read, name), getattr(swing.steps, name))
    legs = written["swing"]["legs"]
    wrong: tuple[dict[str, object], ...] = (
        {"homes": [[9.0] * 3] * 2}, {"cycle": []}, {"duty": 2.0}, {"heights": [0.0]}, {"speed": -1.0},
    )  # fmt: skip
    for broken in wrong:
        with pytest.raises(InputError, match=r"a\.elbow|motions"):
            MotionSet.from_dict({**written, "swing": {**written["swing"], "legs": {**legs, **broken}}}, "a.elbow")


def knees(positions: Floats, names: tuple[str, ...]) -> Floats:
    """How far both knees (n, 2) are bent, radians, for joints (n, J, 3)."""
    bends = []
    for side in ("left", "right"):
        hip, knee, ankle = (positions[:, names.index(side + part)] for part in ("UpperLeg", "LowerLeg", "Foot"))
        thigh, shin = knee - hip, ankle - knee
        cosine = (thigh * shin).sum(axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shin, axis=1)
        bends.append(np.arccos(np.clip(cosine, -1.0, 1.0)))
    return np.stack(bends, axis=1)


def over_a_stride(values: Floats, phases: Floats) -> Floats:
    """The mean of values (n, 2) at 16 phases of the stride."""
    bins = np.floor(np.mod(phases, 1.0) * 16).astype(int)
    return np.stack([values[bins == k].mean(axis=0) for k in range(16)])


def knees_recorded(clip: Clip) -> Floats:
    motion, strides = clip.motion, clip.planning.track.strides
    every = np.stack([motion.position(bone) for bone in motion.bones], axis=1)
    first, last = (round(strides.strikes[k][1]) for k in (0, -1))
    span = slice(None) if strides.loop else slice(first, last)
    return over_a_stride(knees(every, motion.bones)[span], strides.phases[span])


def knees_shown(swing: Swing, own: OwnSteps, stride: OwnStride) -> Floats:
    rows = alive(stepped(even(swing.speed), own), body=body_of(GAIT, own=stride))[240:]
    q = np.zeros((len(rows), DOF))
    q[:, DofGroup.WAIST.at] = swing.goal(DofGroup.WAIST, rows[:, 6], rows[:, 3])
    q[:, :3] = rows[:, :3]
    skeleton = proportional_humanoid().skeleton
    return over_a_stride(knees(posed(proportional_humanoid(), q, rows).positions, skeleton.names), rows[:, 6])


def apart(one: Floats, other: Floats) -> float:
    """Degrees between two strides, in the mean; one may be a little later."""
    return min(float(np.degrees(np.sqrt(np.mean((np.roll(one, k, axis=0) - other) ** 2)))) for k in range(-2, 3))


@needs_shared
@pytest.mark.parametrize(
    "name",
    [
        "walk01.bvh",
        "cmu_02_02_walk.bvh",
        "m2m_human-base-animations.glb#Walk_Loop",
        "m2m_human-base-animations.glb#Crouch_Fwd_Loop",
    ],
)
def test_knees_bend_as_in_the_recording(name: str) -> None:
    """Nearer than those of the plain walk, or within ten degrees: plain knees are those of people too."""
    assert SHARED is not None
    clip = Clip.load(f"{SHARED}/motions/{name}")
    recorded = knees_recorded(clip)
    off = apart(knees_shown(clip.swing, clip.swing.steps, clip.swing.own_on(GAIT)), recorded)
    assert off < 18.0
    assert off < max(apart(knees_shown(clip.swing, CYCLE, clip.swing.own), recorded), 10.0)
