"""The steering benchmark: hands that steer as users do, and what planning under them costs."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.errors import InputError
from elbowroom.experiment.bench.settings import STEERED, SteerSettings
from elbowroom.experiment.bench.steer import amount, run, steered_walk
from elbowroom.experiment.bench.steer_scenes import KEY_FLIPS, corridor, mouse_look, slalom, steered_scenes, wanted_way
from elbowroom.planning.command import Command
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.scene import Scene
from elbowroom.world.walkable import StanceCapsule, stance_segments


def test_there_are_at_least_six_scenes_and_all_can_be_sent_to_a_server() -> None:
    scenes = steered_scenes()
    assert tuple(steered.name for steered in scenes) == STEERED
    assert len(set(STEERED)) >= 6
    for steered in scenes:
        again = Scene.from_dict(steered.scene.to_dict())
        assert len(again.obstacles) == len(steered.scene.obstacles)
        assert len(steered.route) > 1


def test_a_corridor_is_as_broad_as_it_says() -> None:
    steered = corridor("bends", 1.0)
    middles = 0.5 * (steered.route[1:] + steered.route[:-1])
    stance = StanceCapsule(0.1, 0.5, 1.0)
    gaps = clearance(stance_segments(stance, *middles.T), np.array([0.1], np.float32), steered.scene.obstacles.standing)
    assert gaps == pytest.approx(np.full(len(middles), 0.4), abs=1e-5)


def test_a_mouse_changes_the_direction_a_little_with_every_frame() -> None:
    steered, heading = slalom(), 0.0
    steer = mouse_look(steered.route)
    commands = [steer(number / 60.0, 0.0, 0.02 * number) for number in range(200)]
    directions = np.array([command.direction for command in commands], np.float64)
    assert np.all(np.diff(directions) != 0.0)
    assert np.abs(np.diff(directions)).max() < math.radians(10.0)
    assert abs(directions[0] - heading) < 1.0


def test_keys_are_held_in_turn_and_begin_again() -> None:
    steer = KEY_FLIPS(np.array([[0.0, 0.0], [1.0, 0.0]]))
    first, flipped, later = (steer(time, 0.0, 0.0).direction for time in (0.5, 1.1, 2.8 + 0.5))
    assert first == later == pytest.approx(math.pi / 2)
    assert flipped == pytest.approx(math.radians(135.0))


def test_what_a_command_asks_for_is_a_velocity_on_the_ground() -> None:
    assert wanted_way(Command(forward=1.0, direction=math.pi / 2), 0.3) == pytest.approx((1.1, 0.0))
    assert wanted_way(Command(), 0.3) == (0.0, 0.0)
    assert wanted_way(Command(strafe=1.0), 0.0)[0] > 0.5


def test_equal_walks_do_equal_work_and_others_start_elsewhere() -> None:
    humanoid, (steered,) = Humanoid.default(), steered_scenes(["slalom"])
    first, again, other = (steered_walk(humanoid, steered, 2.0, seed) for seed in (1, 1, 2))
    assert [call.checks for call in first.calls] == [call.checks for call in again.calls]
    assert first.made == again.made != other.made
    assert first.touching == 0
    assert 0.5 < first.made / first.asked < 1.1


def test_the_report_counts_all_walks() -> None:
    settings = SteerSettings(("c, strafing", "slalom"), seconds=1.0, rounds=2)
    done: list[int] = []
    report = run(settings, done.append)
    assert done == [1, 2, 3, 4]
    assert amount(settings) == 4
    assert [row.scene for row in report.scenes] == ["slalom", "c, strafing"]
    assert report.overall.calls == sum(row.calls for row in report.scenes)
    assert report.overall.seconds == pytest.approx(4.0)
    assert report.overall.worst_checks == max(row.worst_checks for row in report.scenes)


def test_nonsense_is_refused() -> None:
    with pytest.raises(InputError, match="seconds 0"):
        SteerSettings(seconds=0.0)
    with pytest.raises(InputError, match="rounds 0"):
        SteerSettings(rounds=0)
    result = CliRunner().invoke(app, ["bench", "steer", "--scene", "nowhere", "--json"], standalone_mode=False)
    assert result.return_value == 2
    assert "nowhere" in result.output
