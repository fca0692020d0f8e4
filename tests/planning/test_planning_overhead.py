"""Low places: only what hangs over all of a way counts, and the lower it hangs the slower one goes under it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.narrow.build import build_of
from elbowroom.planning.narrow.overhead import low_places
from elbowroom.planning.narrow.pace import slow_under
from elbowroom.planning.narrow.places import NarrowPlaces
from elbowroom.planning.root.line.line import new_line
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Thing = dict[str, object]

HUMANOID = Humanoid.default()
BUILD = build_of(HUMANOID, body_model(HUMANOID))
LINE = new_line(RootState(), Command(forward=1.0), RootMotionSettings())
AT = 2.0  # metres ahead: where things hang
T = 0.15


def box(x: float, low: float, high: float, wide: float, thick: float = 0.2) -> Thing:
    return {"type": "box", "center": [x, 0.5 * (low + high), AT], "size": [wide, high - low, thick]}


def scene(*boxes: Thing) -> Scene:
    return Scene.of("low", list(boxes), finish=(0.0, 5.0))


def beam(under: float, thick: float = 0.2) -> Scene:
    return scene(box(0.0, under, under + 0.6, 3.0, thick))


def slowest(place: Scene) -> float:
    """The least share of the wanted speed on a line that leads under it."""
    places = slow_under(NarrowPlaces(BUILD, place.free_map), LINE, 0.0, 4.0, 0.0)
    assert np.all(np.abs(places[:, 1] - AT) < 0.5)
    return float(places[:, 2].min(initial=1.0))


@given(under=st.floats(1.08, 1.75), thick=st.floats(0.05, 0.6))
@settings(max_examples=15, deadline=None)
def test_how_low_it_hangs_is_known_to_two_centimetres(under: float, thick: float) -> None:
    ways = np.array([[0.0, AT, 0.0, 1.0], [0.3, AT, 0.0, 1.0]])
    found = low_places(NarrowPlaces(BUILD, beam(under, thick).free_map), ways, 0.0)
    assert found[:, 2] == pytest.approx(np.full(2, under), abs=0.02)


def test_the_lower_it_hangs_the_slower_and_by_no_leaps() -> None:
    shares = np.array([slowest(beam(under)) for under in np.arange(1.85, 1.09, -0.03)])
    assert shares[0] == pytest.approx(1.0)
    assert np.all(np.diff(shares) <= 1e-9)
    assert np.abs(np.diff(shares)).max() < 0.03
    assert 0.75 <= slowest(beam(1.40)) <= 0.85
    assert 0.6 <= shares[-1] <= 0.65


@pytest.mark.parametrize(
    "place",
    [
        scene(),
        beam(BUILD.tall + 0.07),
        scene(box(0.0, 0.0, 0.9, 3.0)),  # a table
        scene(box(0.0, 0.0, 2.4, 3.0)),  # a wall
        scene(box(0.6, 1.3, 1.9, 0.4)),  # hangs beside
        scene(box(0.0, 1.3, 1.9, 0.06, 0.06)),  # a lamp
        scene(box(-0.8, 0.0, 2.4, 1.0), box(0.8, 0.0, 2.4, 1.0)),  # a gap
    ],
    ids=["open", "high", "table", "wall", "beside", "lamp", "gap"],
)
def test_where_nobody_has_to_duck_nobody_is_slower(place: Scene) -> None:
    assert slowest(place) == pytest.approx(1.0)


@pytest.mark.parametrize("under", [1.15, 1.5])
def test_slowing_down_is_the_same_from_plan_to_plan_and_costs_nothing(under: float) -> None:
    planner, command = RootPlanner(HUMANOID, beam(under)), Command(forward=1.0)
    plan = planner.plan(Asked(RootState(forward=1.1), command, 20, T))
    speeds = plan.path.states[:, 3]
    assert speeds.min() < 1.1 * slowest(beam(under)) + 0.05
    assert speeds[-1] > speeds.min() + 0.05
    assert plan.lost == pytest.approx(0.0, abs=1e-6)
    for k in range(1, 16):
        later = planner.plan(Asked(RootState(*plan.path.states[k].tolist()), command, 20 - k, T, k * T))
        assert np.abs(later.path.states - plan.path.states[k:]).max() < 1e-9


def test_a_way_with_corners_is_slower_there_too() -> None:
    way = ((0.0, 0.0), (0.0, 4.0), (2.0, 4.0))
    command = Command(forward=1.0, direction=0.0, way=way)
    slow, free = (
        RootPlanner(HUMANOID, place).plan(Asked(RootState(forward=1.1), command, 20, T)).path.states
        for place in (beam(1.2), scene())
    )
    assert slow[:, 3].min() < 0.8
    assert slow[-1, 1] < free[-1, 1] - 0.2
