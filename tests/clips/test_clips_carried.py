"""Hips and chest of a recorded walk: found as they were carried, and shown so again."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.carriage import AHEAD, ASIDE, CHEST_BEND, CHEST_LIST, CHEST_TURN, LIST, POSING, TURN
from elbowroom.body.gait.living import body_of
from elbowroom.body.gait.own_stride import PUBLISHED, OwnStride
from elbowroom.body.root import WITH_FEET
from elbowroom.clips.clip import Clip, motions_of
from elbowroom.clips.motion_set import MotionSet
from elbowroom.clips.planning_motion import planning_motion
from elbowroom.clips.swing import Swing, swing_of
from elbowroom.errors import InputError
from feet_walks import BODY, DT, GAIT, alive, path, walked
from made_walk import captured, made_walk
from shared_data import SHARED, needs_shared

Floats = NDArray[np.float64]

SPEED = 1.1  # m/s
WHOLE = (ASIDE, AHEAD, TURN, LIST, CHEST_LIST)


def carried_by(motions: MotionSet) -> OwnStride:
    assert motions.swing is not None
    return motions.swing.own


def rows_at(speed: float) -> Floats:
    return walked(path(lambda _: (speed, 0.0, 0.0), 480))


def swing_seen(rows: Floats) -> Swing:
    """The swing of who was captured so, its upper body at rest."""
    motion = captured(proportional_humanoid(), rows, np.zeros((len(rows), LOCAL)))
    return swing_of(planning_motion(motion), "made")


@pytest.fixture(scope="module")
def vivid() -> Swing:
    """Of a walker whose hips do more than is published."""
    return swing_seen(alive(rows_at(SPEED), body=BODY._replace(amounts=BODY.amounts * 1.5))[180:])


def test_hips_and_chest_are_carried_as_they_were_seen(vivid: Swing) -> None:
    assert vivid.speed == pytest.approx(SPEED, rel=0.2)  # hips that ripple so are slow over the flat foot
    rows = rows_at(SPEED)
    shown = alive(rows, body=body_of(GAIT, own=vivid.own._replace(speed=SPEED)))[180:]
    seen = alive(rows, body=BODY._replace(amounts=BODY.amounts * 1.5))[180:]
    for column in WHOLE:
        assert np.ptp(shown[:, column]) == pytest.approx(np.ptp(seen[:, column]), rel=0.1), column
        assert np.corrcoef(shown[:, column], seen[:, column])[0, 1] > 0.9, (
            column
        )  # feet strike a little after they are farthest ahead
    assert np.abs(shown[:, [CHEST_TURN, CHEST_BEND]]).max() < 1e-9  # these are planned


def test_who_carries_nothing_gives_nothing() -> None:
    harmonics = swing_of(planning_motion(made_walk()), "made").own.harmonics
    assert np.abs(harmonics).max() < 0.01


def test_it_fades_to_rest_and_does_not_jump(vivid: Swing) -> None:
    body = body_of(GAIT, own=vivid.own)
    wanted = path(lambda t: (1.3 if t < 3.0 else -0.6 if t < 5.0 else 0.0, 0.0, 0.0), 480)
    shown = alive(walked(wanted), body=body)[:, WITH_FEET : WITH_FEET + POSING]
    still = alive(walked(wanted))[:, WITH_FEET : WITH_FEET + POSING]
    np.testing.assert_allclose(shown[-60:], still[-60:], atol=1e-4)  # it rests as all do
    quickest = np.array([0.9, 0.4, 0.9, 2.4, 2.4, 2.4, 1.2, 0.7, 4.1, 0.5])
    assert (np.abs(np.diff(shown, axis=0)).max(axis=0) <= DT * quickest).all()


def test_recordings_keep_it_and_those_without_walk_as_before(vivid: Swing) -> None:
    written = json.loads(json.dumps(MotionSet(vivid).to_dict()))
    read = carried_by(MotionSet.from_dict(written, "a.elbow"))
    np.testing.assert_array_equal(read.harmonics, vivid.own.harmonics)
    assert read.speed == vivid.own.speed
    broken = {**written, "swing": {**written["swing"], "carried": {"harmonics": [[2.0]], "speed": 1.0}}}
    with pytest.raises(InputError, match="carried"):
        MotionSet.from_dict(broken, "a.elbow")
    del written["swing"]["carried"], written["swing"]["legs"]
    assert MotionSet.from_dict(written, "a.elbow").own_stride(GAIT) is PUBLISHED


def test_a_limp_and_a_wild_walk_stay_within_what_a_body_shows() -> None:
    motion = made_walk()
    wild = motion.hips + np.outer(np.sin(np.arange(len(motion)) * 0.0942), [0.6, 0.0, 0.0])
    own = swing_of(planning_motion(replace(motion, hips=wild)), "made").own
    assert np.abs(own.harmonics[1:, ASIDE - WITH_FEET]).max() <= 0.08


@needs_shared
@pytest.mark.parametrize(
    ("name", "degrees"), [("cmu_02_02_walk.bvh", (12, 22)), ("walk01.bvh", (6, 15)), ("fair1_zombie.bvh", (10, 25))]
)
def test_recorded_people_turn_their_hips(name: str, degrees: tuple[float, float]) -> None:
    own = carried_by(motions_of(Clip.load(f"{SHARED}/motions/{name}")))
    rows = alive(rows_at(own.speed), body=body_of(GAIT, own=own))[180:]
    low, high = degrees
    assert low < np.degrees(np.ptp(rows[:, TURN])) < high
    assert 0.02 < np.ptp(rows[:, ASIDE]) < 0.16
