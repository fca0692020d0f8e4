"""Tours: targets that can be reached, legs that end, what was shown judged, the command."""

import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.control.controller import Controller
from elbowroom.experiment.judge.verdict import Judging
from elbowroom.experiment.tour.leg import NO_WAY, OUT_OF_TIME, walk_to
from elbowroom.experiment.tour.targets import random_targets
from elbowroom.experiment.tour.tour import FrameCollector, Milliseconds, judging, run_tour
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.way import NoWayError
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import Scene
from place_builder import write_place


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return Humanoid.default()


@pytest.fixture(scope="module")
def rooms(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    """Two rooms whose door is left out."""
    path = write_place(tmp_path_factory.mktemp("places") / "rooms.glb")
    return Scene.load(path, PlaceOptions(drop=("Door_*",)))


def test_both_rooms_are_visited_and_nothing_is_touched(humanoid: Humanoid, rooms: Scene) -> None:
    controller = Controller(humanoid, rooms)
    shown = FrameCollector(controller.step(Command(), 0.0))
    heard = []
    result = run_tour(controller, [(0.0, 6.0), (-1.2, 1.0)], shown.append, lambda number, leg: heard.append(number))
    assert (result.targets, result.arrived, heard) == (2, 2, [0, 1])
    assert result.plan_ms.count == result.plan_cpu_ms.count > 10
    assert result.plan_ms.worst < result.plan_ms.total <= result.plan_ms.count * result.plan_ms.worst
    assert result.frame_ms.count == result.plan_cpu_ms.count + result.frame_cpu_ms.count
    walk = judging(shown, controller, mesh=False)
    next(parts := walk.parts())
    first = walk.verdict()
    assert (first.clean, first.poses > 0, first.poses + first.left) == (False, True, walk.poses)
    assert list(parts)[-1] == pytest.approx(result.seconds, abs=0.1)
    verdict = walk.verdict()
    assert verdict.clean
    assert verdict.poses > 4 * 60 * result.seconds - 10


def test_a_closed_door_is_no_way_and_the_floor_ends_at_the_walls(humanoid: Humanoid, tmp_path: Path) -> None:
    controller = Controller(humanoid, Scene.load(write_place(tmp_path / "rooms.glb")))
    other = (0.0, 6.0) if controller.root.z < 4.0 else (0.0, 2.0)
    leg, cost = walk_to(controller, other, 10.0)
    assert (leg.outcome, leg.seconds, len(cost.frame_ms)) == (NO_WAY, 0.0, 0)
    assert "no way leads" in leg.reason
    with pytest.raises(NoWayError, match="nobody can stand at 4"):
        controller.goto((4.0, controller.root.z))


def test_who_is_too_slow_runs_out_of_time(humanoid: Humanoid) -> None:
    leg, _ = walk_to(Controller(humanoid, Scene.load("empty")), (0.0, 5.0), 1.0)
    assert (leg.outcome, leg.arrived) == (OUT_OF_TIME, False)


def test_targets_are_drawn_by_the_seed_from_what_can_be_reached(humanoid: Humanoid, rooms: Scene) -> None:
    navigator = Controller(humanoid, rooms).navigator
    targets = random_targets(navigator, (0.0, 2.0), 30, 5)
    assert targets == random_targets(navigator, (0.0, 2.0), 30, 5)
    assert targets != random_targets(navigator, (0.0, 2.0), 30, 6)
    assert any(z > 4.5 for _, _, z in targets)
    assert any(z < 3.5 for _, _, z in targets)
    for target in targets:
        assert math.isfinite(navigator.find((0.0, 2.0), target).left((0.0, 2.0)))


def test_costs_are_told_by_median_and_tail() -> None:
    assert Milliseconds.of(np.empty(0)) == Milliseconds(0, 0.0, 0.0, 0.0, 0.0)
    assert Milliseconds.of(np.arange(101.0)) == Milliseconds(101, 50.0, 99.0, 100.0, 5050.0)


@pytest.mark.long
def test_the_command_tells_it_as_json() -> None:
    done = CliRunner().invoke(app, ["tour", "a", "--targets", "2", "--seed", "3", "--json", "-q"])
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert {"targets", "arrived", "stuck", "touching_frames", "plan_ms", "plan_cpu_ms", "given_up"} <= set(told)
    assert (told["targets"], told["arrived"], told["touching_frames"], told["given_up"]) == (2, 2, 0, [])


@pytest.mark.long
def test_a_judgement_that_is_broken_off_leaves_the_walk_and_what_was_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = Judging.parts

    def broken_off(judging: Judging) -> Iterator[float]:
        yield next(whole(judging))
        raise KeyboardInterrupt

    monkeypatch.setattr(Judging, "parts", broken_off)
    done = CliRunner().invoke(app, ["tour", "a", "--targets", "3", "--seed", "3", "--json", "-q"])
    assert done.exit_code != 0
    told = json.loads(done.stdout)
    assert (told["arrived"], told["touching_frames"]) == (3, 0)
    assert told["frames_judged"] > 0
    every = told["frames_judged"] + told["frames_not_judged"]
    assert told["frames_not_judged"] > 0
    assert f"not judged to the end: {told['frames_judged']} of {every} poses" in done.stderr


def test_so_many_targets_are_none() -> None:
    assert CliRunner().invoke(app, ["tour", "a", "--targets", "0"]).exit_code == 2
