"""Walking to a place: there, round things, given up with a reason, and taken over by the next key."""

import math
from collections.abc import Sequence
from itertools import pairwise, product
from pathlib import Path

import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import FORWARD, Controller
from elbowroom.control.journey import Journey, JourneyState
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.control.recordings.replay import replay
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import NoWayError, Place, Spot, Way
from elbowroom.planning.root.plan import RootPlanKind
from elbowroom.world.scene import Scene
from stairs import BEFORE, ON_FLOOR, TREADS, spiral_stair, tread_top

DT = 1 / 60
LONG = 60.0  # seconds


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return Humanoid.default()


def walk(controller: Controller, seconds: float = LONG) -> float:
    """Let it walk; the least clearance on the way."""
    journey, clearance = controller.journey, math.inf
    assert journey is not None
    for _ in range(round(seconds / DT)):
        frame = controller.step(Command(), DT)
        clearance = min(clearance, frame.clearance)
        if not journey.walking and controller.stands:
            break
    return clearance


def away(controller: Controller, place: tuple[float, float]) -> float:
    return math.dist((controller.root.x, controller.root.z), place)


@pytest.mark.parametrize(("scene", "place"), [("a", (0.5, 6.0)), ("d", (0.0, 4.0)), ("empty", (-2.0, -3.0))])
def test_it_gets_there_and_stands(humanoid: Humanoid, scene: str, place: tuple[float, float]) -> None:
    controller = Controller(humanoid, Scene.load(scene))
    journey = controller.goto(place)
    assert walk(controller) >= 0.0
    assert journey.state is JourneyState.ARRIVED
    assert away(controller, place) < 0.2
    assert controller.stands


def test_a_key_takes_over_at_once_and_for_good(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, Scene.load("empty"))
    journey = controller.goto((0.0, 5.0))
    walk(controller, 1.0)
    back = Command(forward=-1.0)
    assert controller.step(back, DT).command == back
    assert journey.state is JourneyState.TAKEN_OVER
    assert controller.step(Command(), DT).command.idle


def test_a_reset_ends_it(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, Scene.load("empty"))
    controller.goto((0.0, 5.0))
    walk(controller, 1.0)
    controller.reset()
    assert controller.journey is None
    assert controller.step(Command(), DT).command.idle


def test_what_is_recorded_of_it_replays(humanoid: Humanoid, tmp_path: Path) -> None:
    path = tmp_path / "run.elbow"
    controller = Controller(humanoid, Scene.load("a"))
    with Recorder(path, controller) as recorder:
        controller.goto((0.5, 4.0))
        for _ in range(300):
            frame = controller.step(Command(), DT)
            recorder.append(frame, DT)
    recording = Recording(path)
    assert replay(recording, humanoid).identical
    assert len(recording.ways) > 1, "the way was not kept"


@pytest.mark.long
def test_it_replays_where_something_has_come_into_the_way(humanoid: Humanoid, tmp_path: Path) -> None:
    """Who is led to a place waits less before going back than who is steered: the recording says who is."""
    walls = [{"type": "box", "center": [x, 1.0, 3.0], "size": [0.2, 2.0, 4.0]} for x in (-0.6, 0.6)]
    walls += [{"type": "box", "center": [x, 1.0, 3.0], "size": [30.0, 2.0, 0.2]} for x in (-15.6, 15.6)]  # no way round
    track = [{"center": [0.0, 0.6, 2.6], "seconds": 8}, {"center": [0.0, 0.6, 2.9], "seconds": 1}]
    gate = {"type": "box", "name": "gate", "size": [0.9, 1.2, 0.3], "repeat": "pingpong", "track": track}
    scene = Scene.from_dict(Scene.of("gate", walls, finish=(0.0, 6.0)).to_dict() | {"moving": [gate]})
    controller, path, stuck = Controller(humanoid, scene), tmp_path / "gate.elbow", 0
    with Recorder(path, controller) as recorder:
        controller.goto((0.0, 6.0))
        for _ in range(round(13.5 / DT)):
            frame = controller.step(Command(), DT)
            assert frame.command.led
            assert not frame.command.may_climb
            recorder.append(frame, DT)
            stuck += frame.stuck
    assert stuck > 1.0 / DT
    assert replay(Recording(path), humanoid).identical


def test_a_walled_in_place_is_refused_and_nothing_changes(humanoid: Humanoid) -> None:
    across = [{"type": "box", "center": [0.0, 1.0, z], "size": [2.2, 2.0, 0.2]} for z in (2.0, 4.0)]
    along = [{"type": "box", "center": [x, 1.0, 3.0], "size": [0.2, 2.0, 2.2]} for x in (-1.0, 1.0)]
    controller = Controller(humanoid, Scene.of("pen", [*across, *along], finish=(0.0, 6.0)))
    with pytest.raises(NoWayError, match="no way leads"):
        controller.goto((0.0, 3.0))
    assert controller.journey is None
    with pytest.raises(InputError):
        controller.goto((math.inf, 3.0))


def test_what_is_blocked_for_long_is_given_up_with_the_place(humanoid: Humanoid) -> None:
    """The avatar never moves, whatever it is told."""
    controller = Controller(humanoid, Scene.load("empty"))
    journey = Journey(controller.navigator, controller.navigator.find((0.0, 0.0), (0.0, 5.0)), FORWARD)
    told = list[Command]()
    for _ in range(round(120.0 / DT)):
        told.append(journey.command(RootState(), DT, stuck=True, plans=len(told) // 10))
        if not journey.walking:
            break
    assert journey.state is JourneyState.GIVEN_UP
    assert "blocked at 0.00, 0.00" in journey.reason
    assert any(command.forward < 0.0 for command in told), "it never stepped back"
    directions = {round(command.direction, 2) for command in told if command.direction is not None}
    assert len(directions) > 1, "it never tried another way"
    assert told[-1].idle


def test_each_time_one_steps_back_farther(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, Scene.load("empty"))
    journey = Journey(controller.navigator, controller.navigator.find((0.0, 0.0), (0.0, 5.0)), FORWARD)
    backs, frames = [0], 0
    while journey.walking:
        frames += 1
        back = journey.command(RootState(), DT, stuck=True, plans=frames // 10).forward < 0.0
        if back:
            backs[-1] += 1
        elif backs[-1]:
            backs.append(0)
    assert backs[:-1] == pytest.approx([backs[0] * times for times in range(1, 7)], abs=6)


def test_who_comes_no_farther_gives_up_however_far_he_steps_back(humanoid: Humanoid) -> None:
    """At 2 m nobody gets on; there and back again is no progress."""
    controller = Controller(humanoid, Scene.load("empty"))
    journey = Journey(controller.navigator, controller.navigator.find((0.0, 0.0), (0.0, 5.0)), FORWARD)
    along, frames = 0.0, 0
    while journey.walking:
        frames += 1
        forward = journey.command(RootState(z=along), DT, stuck=along >= 2.0, plans=frames // 10).forward
        along = min(along + 1.1 * forward * DT, 2.0)
        assert frames * DT < 90.0
    assert journey.state is JourneyState.GIVEN_UP
    assert "blocked at 0.00, 2.00" in journey.reason


@pytest.mark.parametrize(("interval", "seconds"), [(0.15, 1.2), (0.4, 2.4), (3.0, 4.0)])
def test_who_plans_slowly_steps_back_later(humanoid: Humanoid, interval: float, seconds: float) -> None:
    """So many plans are waited for as one makes in a second where they are quick; 4 s at most."""
    controller = Controller(humanoid, Scene.load("empty"))
    journey = Journey(controller.navigator, controller.navigator.find((0.0, 0.0), (0.0, 5.0)), FORWARD)
    frames = 0
    while journey.command(RootState(), DT, stuck=True, plans=int(frames * DT / interval)).forward >= 0.0:
        frames += 1
    assert frames * DT == pytest.approx(seconds, abs=2.0 * DT)


def test_who_is_stuck_nearly_there_has_arrived_however_slowly_he_plans(humanoid: Humanoid) -> None:
    """Waiting for more plans, one went back the way one came, and began anew: low roofs end ways so."""
    controller = Controller(humanoid, Scene.load("empty"))
    journey = Journey(controller.navigator, controller.navigator.find((0.0, 0.0), (0.0, 5.0)), FORWARD)
    frames = 0
    while journey.walking:
        journey.command(RootState(z=4.75), DT, stuck=True, plans=frames // 60)
        frames += 1
        assert frames * DT < 1.5
    assert journey.state is JourneyState.ARRIVED


def bend() -> Scene:
    """A wall across, which ends on the left; one has to go round its end, and back."""
    return Scene.of("bend", [{"type": "box", "center": [-1.5, 1.2, 2.5], "size": [6.0, 2.4, 0.2]}], finish=(0.0, 5.0))


def test_one_way_is_walked_along_round_its_corners_and_planned_on(humanoid: Humanoid) -> None:
    """At a corner there is no other command, and so no other plan: what is left of the last one is gone on with."""
    controller, ways, anew = Controller(humanoid, bend()), set(), 0
    journey = controller.goto((-2.0, 4.5))
    number, plans = -1, 0
    while journey.walking:
        frame = controller.step(Command(), DT)
        assert frame.clearance >= 0.0
        assert frame.time < LONG
        if frame.command.way:
            ways.add(frame.command.way)
        if frame.plan is not None and frame.plan.number != number:
            number, plans = frame.plan.number, plans + 1
            anew += frame.plan.local.velocities is None or frame.plan.root.kind is not RootPlanKind.STRAIGHT
    assert journey.state is JourneyState.ARRIVED
    assert len(ways) == 1
    assert max(map(len, ways)) > 2
    assert anew < plans / 10


def test_who_was_led_off_the_way_looks_for_it_again(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, bend())
    journey = Journey(controller.navigator, controller.navigator.find((0.0, 0.0), (-2.0, 4.5)), FORWARD)
    way = journey.command(RootState(), DT, stuck=False, plans=0).way
    assert journey.command(RootState(0.1, 0.2), DT, stuck=False, plans=0).way == way
    other = journey.command(RootState(-2.0, 1.0), DT, stuck=False, plans=0).way
    assert other != way
    assert math.dist(other[0], (-2.0, 1.0)) < 0.1
    assert math.dist(other[-1], (-2.0, 4.5)) < 0.1


def test_what_was_taken_to_be_closed_is_open_again_for_who_finds_no_other_way(humanoid: Humanoid) -> None:
    class Gap(Navigator):
        """Aside there is no way but through what is closed."""

        def again(self, way: Way, start: Place | Spot, closed: Sequence[tuple[Spot, float]]) -> Way:
            if closed and start[0] < -1.0:
                raise NoWayError("no way")
            return super().again(way, start, closed)

    navigator = Gap(humanoid, bend())
    journey, frames = Journey(navigator, navigator.find((0.0, 0.0), (-2.0, 4.5)), FORWARD), 0
    while not journey._closed:
        frames += 1
        journey.command(RootState(), DT, stuck=True, plans=frames)
    for _ in range(round(3.0 / DT)):
        command = journey.command(RootState(-2.0, 1.0), DT, stuck=False, plans=frames)
    assert journey.walking
    assert math.dist(command.way[-1], (-2.0, 4.5)) < 0.1


@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
def test_on_a_spiral_stair_the_same_is_asked_for_all_the_way(humanoid: Humanoid, up: bool) -> None:
    """Also some centimetres beside the way, from where the next corner may be out of sight."""
    top, navigator = tread_top(TREADS), Navigator(humanoid, spiral_stair())
    ends = ((BEFORE[0], 0.0, BEFORE[1]), (ON_FLOOR[0], top, ON_FLOOR[1]))
    start, goal = ends if up else ends[::-1]
    way = navigator.find(start, goal)
    journey, corners = Journey(navigator, way, FORWARD), way.corners(start, 6.0)
    asked = {journey.command(RootState(x=start[0], z=start[2], height=start[1]), DT, stuck=False, plans=0).way}
    for begin, end in pairwise(corners[:-1].tolist()):
        heading = math.atan2(end[0] - begin[0], end[2] - begin[2])
        for part, aside in product((0.0, 0.5), (-0.08, 0.0, 0.08)):
            x, height, z = (a + part * (b - a) for a, b in zip(begin, end, strict=True))
            here = RootState(x=x + aside * math.cos(heading), z=z - aside * math.sin(heading), height=height)
            asked.add(journey.command(here, DT, stuck=False, plans=0).way)
    assert len(asked) == 1
