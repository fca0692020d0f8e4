"""Feet that glide on ground that is not a plane: where they have no room at once they take another way."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.gait.foot_state import standing
from elbowroom.body.gait.footholds import UNKNOWN
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import RISES, ROOT_STATE
from elbowroom.clips.motion_set import STOCK
from elbowroom.control.feet.above_soles import AboveSoles
from elbowroom.control.feet.arms_beside_legs import arms_beside_legs
from elbowroom.control.feet.feet import Around, FeetMoment, LookAbout, RoomAbove
from elbowroom.control.feet.raised import raised
from elbowroom.control.feet.stepping import Stepping
from elbowroom.control.key_frame_queue import Playback
from elbowroom.control.plans.canned import standing_posture
from elbowroom.world.ground.ground import PLAIN
from elbowroom.world.scene import Scene
from feet_walks import in_world

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
DT = 1 / 60
STEP = {"type": "box", "center": [0.0, 0.1, 2.0], "size": [3.0, 0.2, 2.0]}
HUMANOID, UPPER = Humanoid.default(), np.zeros(LOCAL)
FEET = Stepping(HUMANOID, STOCK, AboveSoles(body_model(HUMANOID), Scene.of("step", [STEP], finish=(0.0, 5.0)).ground))


def before(rise: float) -> Floats:
    """A root state on the plane whose right foot is raised."""
    root = np.zeros(ROOT_STATE)
    root[RISES + 2] = rise
    return root


def settling(rise: float, look: LookAbout) -> list[Playback]:
    """How a pose with a raised foot is held where legs are not clear enough to step."""
    shown = FEET.standing(before(0.0))
    shown[RISES + 2] = rise
    moment = FeetMoment(
        Playback(shown, UPPER, UPPER),
        UPPER,
        DT,
        UNKNOWN,
        -1.0,
        look,
        lambda roots, upper, farthest: 0.0,
        lambda root, upper: 0.0,
    )
    return list(FEET.settling(moment, Playback(shown, UPPER, UPPER)))


def test_feet_go_slowly_to_what_they_stand_on_or_at_once_or_stay() -> None:
    ways = [float(root[RISES + 2]) for root in raised(before(0.2), before(0.0), DT)]
    assert ways[0] > ways[1] > ways[2] == 0.0
    assert np.allclose(ways, [0.2 - 2.25 * DT, 0.2 - 4.0 * DT, 0.0, 0.2])
    assert [float(root[RISES + 2]) for root in raised(before(0.2), before(0.2), DT)] == [0.2]


def test_feet_that_glide_are_raised_slowly_first_and_stay_last() -> None:
    ways = settling(0.2, lambda root, upper, axes=None: Around(0.05, lasts=True))
    heights = list(dict.fromkeys(round(float(root[RISES + 2]), 6) for root, _, _ in ways))
    assert len(heights) == 4, "each of them may be shown, if no better one is free"
    assert np.isclose(heights[0], 0.2 - 2.25 * DT)


def test_arms_make_way_for_raised_legs_and_if_that_touches_they_are_as_planned() -> None:
    arms = arms_beside_legs(HUMANOID, STOCK)
    ways = settling(0.3, lambda root, upper, axes=None: Around(0.05, lasts=True))
    spread = [way for way in ways if way.upper is not UPPER]
    assert spread, "no leg comes near a hand"
    assert spread[0] is ways[0]
    assert np.allclose(spread[0].upper, arms.apart(spread[0].root, UPPER))
    assert any(np.allclose(way.root, spread[0].root) for way in ways if way.upper is UPPER)


def ways_under(rise: float, room_above: RoomAbove) -> list[Playback]:
    """How a pose is shown next whose right foot was raised and is planned on the ground."""
    shown = FEET.standing(before(0.0))
    shown[RISES + 2] = rise
    look = Around(0.5, lasts=True)
    moment = FeetMoment(
        Playback(shown, UPPER, UPPER),
        UPPER,
        DT,
        UNKNOWN,
        -1.0,
        lambda *_: look,
        lambda roots, upper, farthest: 0.0,
        room_above,
    )
    return [way for way, _ in FEET.under(moment, [(Playback(before(0.0), UPPER, UPPER), np.zeros(3))])]


def test_whatever_feet_do_arms_make_way_and_ways_with_a_hand_in_a_thigh_come_last() -> None:
    arms, ways = arms_beside_legs(HUMANOID, STOCK), ways_under(0.3, lambda root, upper: 1.0)
    clear = [arms.are_clear(way.root, way.upper) for way in ways]
    first_touching = clear.index(False)
    assert not any(clear[first_touching:])
    made = {way.root.tobytes() for way in ways[:first_touching]}
    assert {way.root.tobytes() for way in ways[first_touching:]} <= made, "each leg has a way with arms beside it"


@pytest.mark.parametrize(("near", "farther", "others_first"), [(0.002, 0.02, True), (0.004, 0.02, False)])
def test_what_comes_nearer_than_skin_gives_way_to_what_keeps_off(
    near: float, farther: float, others_first: bool
) -> None:
    stepping = ways_under(0.2, lambda root, upper: 1.0)[0].root
    ways = ways_under(0.2, lambda root, upper: near if np.allclose(root, stepping) else farther)
    assert (not np.allclose(ways[0].root, stepping)) == others_first
    assert any(np.allclose(way.root, stepping) for way in ways), "it is shown where no other is free"


@pytest.mark.parametrize("room", [-1.0, 0.03, 0.5])
def test_no_way_is_told_twice(room: float) -> None:
    """One who stands on the plane and begins to walk, arms clear of the legs: each way is posed and proven once."""
    feet, planned = Stepping(HUMANOID, STOCK, AboveSoles(body_model(HUMANOID), PLAIN)), before(0.0)
    upper = standing_posture(planned)
    shown, near = Playback(feet.standing(planned), upper, UPPER), Around(0.05, lasts=True)
    moment = FeetMoment(shown, upper, DT, UNKNOWN, room, lambda *_: near, lambda *_: 0.0, lambda *_: 0.05)
    planned[3], planned[6] = 0.8, 0.2
    posed = Playback(planned, upper, UPPER)
    for ways in (list(feet.settling(moment, posed)), [way for way, _ in feet.under(moment, [(posed, np.zeros(3))])]):
        assert len(ways) > 1
        assert len({way.root.tobytes() + way.upper.tobytes() for way in ways}) == len(ways)


@pytest.mark.parametrize("room", [-0.02, 0.0, 0.0039])
def test_a_foot_that_stands_does_not_glide_where_legs_would_be_no_clearer(room: float) -> None:
    """Legs that come a tenth of a millimetre too near, whatever feet do: they slid by centimetres, and no more room."""
    feet, planned = Stepping(HUMANOID, STOCK, AboveSoles(body_model(HUMANOID), PLAIN)), before(0.0)
    shown, near = Playback(feet.standing(planned), UPPER, UPPER), Around(0.05, lasts=True)
    moment = FeetMoment(shown, UPPER, DT, UNKNOWN, -1.0, lambda *_: near, lambda *_: room, lambda *_: 0.05)
    planned[3], planned[6] = 0.8, 0.2
    way = feet.next(moment, Playback(planned, UPPER, UPPER)).root
    stands = standing(way)
    assert stands.any()
    for side in np.flatnonzero(stands).tolist():
        moved = in_world(way[None], side) - in_world(shown.root[None], side)
        assert np.abs(moved).max() < 1e-9
