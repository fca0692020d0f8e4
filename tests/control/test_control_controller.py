"""What the controller shows: nothing touches (judged by coal), nothing jumps, and it repeats itself bit for bit."""

import coal
import numpy as np
import pytest

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.errors import InputError
from elbowroom.geometry import quaternion
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from sampled import sampled

HUMANOID = proportional_humanoid(1.72)
MODEL = body_model(HUMANOID)
STOCK = ("a", "b", "c", "d")
DT = 1 / 60


def random_commands(seed: int, seconds: float) -> list[Command]:
    """A restless user: mostly forward, sometimes back, aside, turning, letting go."""
    rng = np.random.default_rng(seed)
    commands: list[Command] = []
    while len(commands) * DT < seconds:
        forward, strafe, turn = rng.choice([1.0, 1.0, 0.6, 0.0, -1.0]), rng.choice([0.0, 0.0, 1.0, -1.0]), 0.0
        if rng.random() < 0.3:
            turn = rng.uniform(-1, 1)
        direction = rng.uniform(-1, 1) if rng.random() < 0.2 else None
        command = Command(float(forward), float(strafe), float(turn), direction, run=bool(rng.random() < 0.2))
        commands += [command] * int(rng.integers(5, 90))
    return commands


def walk(controller: Controller, commands: list[Command], dt: float = DT) -> list[Frame]:
    return [controller.step(command, dt) for command in commands]


def judged_clearance(frame: Frame, scene: Scene) -> float:
    """The least distance from capsules to boxes by coal, metres; negative where they overlap."""
    segments = posture_capsules(MODEL, frame.q[None], frame.root[None])[:, :, 0].astype(float)
    boxes = scene.obstacles
    shapes = [coal.Box(*(2.0 * half)) for half in boxes.half_sizes]
    places = [
        coal.Transform3s(matrix, center)
        for matrix, center in zip(quaternion.to_matrix(boxes.rotations), boxes.centers, strict=True)
    ]
    least = np.inf
    for segment, radius in zip(segments, HUMANOID.capsules.radii, strict=True):
        start, end = segment[:3], segment[3:]
        length = float(np.linalg.norm(end - start))
        axis = (end - start) / max(length, 1e-12)
        turn = coal.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), axis).toRotationMatrix()
        place = coal.Transform3s(turn, 0.5 * (start + end))
        capsule = coal.Capsule(float(radius), length)
        for shape, box_place in zip(shapes, places, strict=True):
            result = coal.DistanceResult()
            coal.distance(capsule, place, shape, box_place, coal.DistanceRequest(), result)
            least = min(least, result.min_distance)
    return least


@pytest.mark.parametrize("name", STOCK)
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
def test_no_shown_pose_touches_anything(name: str, seed: int) -> None:
    scene = Scene.load(name)
    controller = Controller(HUMANOID, scene, seed=seed)
    rng = np.random.default_rng(seed)
    for frame in walk(controller, [Command(forward=1.0)] * 120 + random_commands(seed, 5.0)):
        assert frame.clearance >= 0.0
        assert not frame.touching
        if frame.clearance < 0.05 and rng.random() < 0.2:
            judged = judged_clearance(frame, scene)
            assert judged == pytest.approx(frame.clearance, abs=1e-5)
            assert judged >= -1e-5


@pytest.mark.parametrize("name", sampled(["d", "b"]))
def test_the_same_steps_give_the_same_frames(name: str) -> None:
    commands = random_commands(4, 5.0)
    first = walk(Controller(HUMANOID, Scene.load(name), seed=7), commands)
    controller = Controller(HUMANOID, Scene.load(name), seed=7)
    walk(controller, random_commands(5, 2.0))
    controller.reset()
    again = walk(controller, commands)
    for one, other in zip(first, again, strict=True):
        assert one.q.tobytes() == other.q.tobytes()
        assert one.root.tobytes() == other.root.tobytes()
        assert one.phase is other.phase


@pytest.mark.parametrize("dt", [1 / 240, 1 / 60, 1 / 30, 0.1, 0.25])
def test_any_step_length_walks_and_touches_nothing(dt: float) -> None:
    scene = Scene.load("c")
    controller = Controller(HUMANOID, scene, seed=1)
    frames = walk(controller, [Command(forward=1.0)] * int(2.5 / dt), dt)
    assert all(frame.clearance >= 0.0 for frame in frames)
    assert frames[-1].time == pytest.approx(2.5, abs=dt)
    assert frames[-1].root[1] > scene.start.z + 0.3


def test_on_free_ground_place_and_velocity_never_jump() -> None:
    dt = 1 / 240
    controller = Controller(HUMANOID, Scene.load("empty"), seed=2)
    frames = [controller.step(command, dt) for command in random_commands(9, 6.0) for _ in range(4)]
    q = np.array([frame.q for frame in frames])
    velocity = np.diff(q, axis=0) / dt
    acceleration = np.abs(np.diff(velocity, axis=0)) / dt
    assert np.abs(velocity[:, :2]).max() < 3.0
    assert np.abs(np.diff(velocity, axis=0)[:, 3:]).max() < 1.0, "a jump of an arm's velocity"
    assert acceleration[:, :2].max() < 60.0


def test_letting_go_comes_to_rest_relaxed_and_costs_no_plans() -> None:
    controller = Controller(HUMANOID, Scene.load("empty"))
    relaxed = controller.step(Command(), 0.0).q[3:]
    walk(controller, [Command(forward=1.0)] * 100)
    frames = walk(controller, [Command()] * 300)
    assert not frames[-1].root[3:6].any()
    assert not any(frame.stuck for frame in frames)
    assert frames[-1].plan is frames[-60].plan
    np.testing.assert_allclose(frames[-1].q[3:], relaxed, atol=0.2)
    np.testing.assert_array_equal(frames[-1].q, frames[-2].q)


def test_without_assistance_the_canned_walk_touches_and_goes_on() -> None:
    controller = Controller(HUMANOID, Scene.load("a"), assist=False)
    frames = walk(controller, [Command(forward=1.0)] * 420)
    assert any(frame.touching for frame in frames)
    assert not any(frame.stuck for frame in frames)
    assert all(frame.touching == (frame.clearance < 0.0) for frame in frames)
    np.testing.assert_array_equal(frames[-1].q[3:6], 0.0)


def test_turning_assistance_on_shows_a_free_pose_at_once() -> None:
    controller = Controller(HUMANOID, Scene.load("a"), assist=False)
    while not controller.step(Command(forward=1.0), DT).touching:
        pass
    controller.assist = True
    assert controller.step(Command(), 0.0).clearance >= 0.0
    assert all(frame.clearance >= 0.0 for frame in walk(controller, [Command(forward=1.0)] * 120))


def test_a_pause_changes_nothing() -> None:
    controller = Controller(HUMANOID, Scene.load("a"))
    shown = walk(controller, [Command(forward=1.0)] * 30)[-1]
    paused = controller.step(Command(forward=-1.0), 0.0)
    assert paused.q.tobytes() == shown.q.tobytes()
    assert paused.time == shown.time


@pytest.mark.parametrize("dt", [-0.01, float("nan"), float("inf"), 1e6])
def test_impossible_steps_are_plain_errors(dt: float) -> None:
    controller = Controller(HUMANOID, Scene.load("empty"))
    with pytest.raises(InputError, match="dt"):
        controller.step(Command(), dt)


def test_settings_out_of_range_are_plain_errors() -> None:
    scene = Scene.load("empty")
    for ahead in (Lookahead(queue_size=1), Lookahead(interval=5.0)):
        with pytest.raises(InputError):
            Controller(HUMANOID, scene, ahead=ahead)
    for seed, planner in ((-1, "exact"), (0, "none")):
        with pytest.raises(InputError):
            Controller(HUMANOID, scene, seed=seed, planner=planner)


def test_a_reset_to_where_nobody_can_stand_changes_nothing() -> None:
    scene = Scene.load("d")
    controller, start = Controller(HUMANOID, scene), scene.start
    inside = start._replace(x=float(scene.obstacles.centers[0, 0]), z=float(scene.obstacles.centers[0, 2]))
    controller.push(1, (-2.0, 1.75))
    shown = walk(controller, [Command(forward=1.0)] * 30)[-1]
    things = dict(controller.things)
    with pytest.raises(InputError, match="touches an obstacle"):
        controller.reset(inside)
    assert controller.start == start
    assert controller.things == things
    assert controller.step(Command(), 0.0).q.tobytes() == shown.q.tobytes()
    controller.reset(start._replace(x=start.x + 0.1))
    assert controller.root.x == pytest.approx(start.x + 0.1)
    assert not controller.things
    controller.reset()
    assert controller.root.x == pytest.approx(start.x + 0.1)


def test_a_start_in_an_obstacle_is_a_plain_error() -> None:
    scene = Scene.load("a")
    inside = scene.start._replace(x=float(scene.obstacles.centers[0, 0]), z=float(scene.obstacles.centers[0, 2]))
    with pytest.raises(InputError, match="start"):
        Controller(HUMANOID, scene, start=inside)


def test_before_a_wall_the_avatar_stands_and_is_stuck_only_while_pushed() -> None:
    document = Scene.load("empty").to_dict()
    document["obstacles"] = [{"type": "box", "name": "wall", "center": [0, 1, 2], "size": [9, 2, 0.3]}]
    controller = Controller(Humanoid.default(), Scene.from_dict(document))
    frames = walk(controller, [Command(forward=1.0)] * 400)
    assert frames[-1].stuck
    assert frames[-1].root[1] < 1.85
    assert not walk(controller, [Command()] * 30)[-1].stuck
    back = walk(controller, [Command(forward=-1.0)] * 60)[-1]
    assert not back.stuck
    assert back.root[1] < frames[-1].root[1] - 0.2
