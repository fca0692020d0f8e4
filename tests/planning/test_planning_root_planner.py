"""Root paths: free at every moment, straight where they can be, round or a stop where they cannot."""

import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import Patience, RootPlan, RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

BODY = proportional_humanoid(1.72)
MODEL = body_model(BODY)
MOTION = RootMotionSettings()
INTERVAL, HORIZON = 0.2, 5
FORWARD = Command(forward=1.0)

Box = tuple[Sequence[float], Sequence[float], float]  # centre, size, yaw


def scene_of(*boxes: Box) -> Scene:
    obstacles = [{"type": "box", "center": list(c), "size": list(s), "yaw": yaw} for c, s, yaw in boxes]
    return Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": obstacles})


def wall(z: float, left_end: float, right_end: float) -> Box:
    return [0.5 * (left_end + right_end), 1.1, z], [abs(right_end - left_end), 2.2, 0.2], 0.0


def least_clearance(path: RootPath, scene: Scene, body: Humanoid = BODY) -> float:
    """The judge: legs and pelvis at 240 moments a second of what playback shows."""
    model = MODEL if body is BODY else body_model(body)
    count = int(240 * path.horizon * path.interval) + 1
    states = path.sample(path.start_time + np.linspace(0.0, path.horizon * path.interval, count))
    return float(np.min(clearance(leg_capsules(model, states), model.roots.radii, scene.obstacles.standing)))


def world_velocities(states: Floats) -> Floats:
    sine, cosine = np.sin(states[:, 2]), np.cos(states[:, 2])
    along, across = states[:, 3], states[:, 4]
    return np.stack([along * sine + across * cosine, along * cosine - across * sine], axis=1)


def walk(
    scene: Scene, command: Command | Callable[[int], Command], steps: int, start: RootState | None = None
) -> tuple[Floats, list[RootPlan]]:
    """Replan at every key frame; every path is judged. Returns the states passed and the plans."""
    planner, state = RootPlanner(BODY, scene), start or RootState()
    passed, plans = [state.as_array()], []
    for i in range(steps):
        plan = planner.plan(Asked(state, command(i) if callable(command) else command, HORIZON, INTERVAL))
        assert least_clearance(plan.path, scene) > 0.0
        state = RootState(*plan.path.states[1].tolist())
        passed.append(plan.path.states[1])
        plans.append(plan)
    return np.array(passed), plans


def kinds(plans: list[RootPlan]) -> set[RootPlanKind]:
    return {plan.kind for plan in plans}


def test_free_space_is_crossed_straight_at_walking_speed() -> None:
    states, plans = walk(scene_of(), FORWARD, 20)
    assert kinds(plans) == {RootPlanKind.STRAIGHT}
    np.testing.assert_allclose(states[:, [0, 2, 4, 5]], 0.0, atol=1e-12)
    np.testing.assert_allclose(states[5:, 3], MOTION.walk_speed)
    assert np.all(np.diff(states[:, 6]) > 0.0)
    assert plans[0].goal[1] > 2.0


def test_a_path_starts_exactly_in_the_state_given() -> None:
    start = RootState(0.3, -0.2, 1.0, 0.7, 0.1, 0.4, 3.25)
    plan = RootPlanner(BODY, scene_of()).plan(Asked(start, FORWARD, 4, 0.25, 7.5))
    assert RootState(*plan.path.states[0]) == start
    assert plan.path.start_time == 7.5
    assert plan.path.states.shape == (5, ROOT_STATE)


@pytest.mark.parametrize("x", [0.0, 0.1])
@pytest.mark.parametrize("width", [0.8, 1.2, 2.0])
def test_who_is_led_round_a_pillar_and_pulls_back_to_the_line_is_led_on(x: float, width: float) -> None:
    planner, state = RootPlanner(BODY, scene_of(([x, 0.6, 2.5], [width, 1.2, 0.5], 0.0))), RootState()
    sides = set[int]()
    for _ in range(25):
        back = max(-0.5, min(0.5, -1.5 * state.x))
        plan = planner.plan(Asked(state, Command(forward=1.0, direction=back), HORIZON, INTERVAL))
        state = RootState(*plan.path.states[1].tolist())
        sides |= {round(math.copysign(1.0, state.x))} if abs(state.x) > 0.2 else set()
    assert state.z > 3.2
    assert len(sides) == 1


@pytest.mark.parametrize("direction", [math.radians(20.0), math.radians(-60.0), math.pi])
def test_who_is_led_round_a_pillar_may_go_elsewhere(direction: float) -> None:
    planner, state = RootPlanner(BODY, scene_of(([-0.3, 0.6, 2.5], [1.2, 1.2, 0.5], 0.0))), RootState()
    for _ in range(8):
        plan = planner.plan(Asked(state, Command(forward=1.0, direction=0.0), HORIZON, INTERVAL))
        state = RootState(*plan.path.states[1].tolist())
    assert plan.kind is RootPlanKind.DETOUR
    assert state.x > 0.2  # to the left of the line
    planner.plan(Asked(state, Command(forward=1.0, direction=direction), HORIZON, INTERVAL))
    assert planner.memory.line is not None
    assert math.remainder(planner.memory.line.heading - direction, math.tau) == pytest.approx(0.0)


@pytest.mark.parametrize("x", [-0.3, 0.0, 0.2])
@pytest.mark.parametrize("width", [0.5, 1.2])
def test_a_pillar_is_walked_round_and_the_line_of_travel_taken_up_again(x: float, width: float) -> None:
    states, plans = walk(scene_of(([x, 0.6, 2.5], [width, 1.2, 0.5], 0.0)), FORWARD, 40)
    assert RootPlanKind.DETOUR in kinds(plans)
    assert kinds(plans) <= {RootPlanKind.STRAIGHT, RootPlanKind.DETOUR}
    assert states[-1, 1] > 6.5
    np.testing.assert_allclose(states[-1, [0, 2]], 0.0, atol=0.05)
    # One swerve out and one back: the body does not wag.
    swing = np.abs(np.diff(states[:, 2])).sum()
    assert swing < 3.0


def test_a_wide_wall_is_met_with_a_smooth_stop() -> None:
    states, plans = walk(scene_of(wall(2.5, -4.0, 4.0)), FORWARD, 30)
    assert plans[-1].kind is RootPlanKind.STOPPED
    assert 1.9 < states[-1, 1] < 2.3
    np.testing.assert_allclose(states[-1, 3:6], 0.0, atol=1e-9)
    assert np.all(np.diff(states[:, 1]) >= 0.0)


def test_one_can_back_away_from_a_wall_and_come_again() -> None:
    def command(i: int) -> Command:
        return FORWARD if not 20 <= i < 30 else Command(forward=-1.0)

    states, _ = walk(scene_of(wall(2.5, -4.0, 4.0)), command, 50)
    assert states[20, 1] > 1.9
    assert states[30, 1] < states[20, 1] - 0.6
    assert states[-1, 1] > 1.9


@pytest.mark.parametrize("offset", [0.0, 0.3, 0.7])
def test_a_doorway_that_the_legs_fit_through_is_passed(offset: float) -> None:
    doorway = scene_of(wall(2.5, -4.0, offset - 0.25), wall(2.5, offset + 0.25, 4.0))
    states, _ = walk(doorway, FORWARD, 40)
    assert states[-1, 1] > 6.0


def test_what_only_the_upper_body_would_touch_diverts_nobody() -> None:
    beam = ([0.0, 1.5, 2.0], [3.0, 0.3, 0.2], 0.0)
    board = ([0.5, 0.8, 3.0], [0.5, 0.1, 0.4], 0.2)
    hanging = ([0.0, 1.6, 4.0], [0.4, 0.8, 0.4], 0.5)
    states, plans = walk(scene_of(beam, board, hanging), FORWARD, 30)
    assert not states[:, [0, 2, 4, 5]].any()
    assert kinds(plans) == {RootPlanKind.STRAIGHT}
    states, _ = walk(scene_of(board), FORWARD, 30)  # and slows down nobody who need not duck
    np.testing.assert_array_equal(states, walk(scene_of(), FORWARD, 30)[0])


@pytest.mark.parametrize("name", ["a", "b", "c", "d"])
def test_the_papers_scenes_leave_the_legs_a_straight_way(name: str) -> None:
    states, plans = walk(Scene.load(name), FORWARD, 35)
    assert kinds(plans) == {RootPlanKind.STRAIGHT}
    np.testing.assert_allclose(states[:, 0], 0.0, atol=1e-12)
    assert Scene.load(name).finished(RootState(*states[-1]))


@pytest.mark.parametrize(("run", "seconds"), [(False, 0.4), (True, 0.8)])
def test_letting_go_brings_a_stand(run: bool, seconds: float) -> None:
    states, _ = walk(scene_of(), lambda i: Command(forward=1.0, run=run) if i < 8 else Command(), 8 + 5)
    assert states[8, 3] == pytest.approx(MOTION.run_speed if run else MOTION.walk_speed)
    stand = states[8 + round(seconds / INTERVAL)]
    np.testing.assert_allclose(stand[3:6], 0.0, atol=1e-9)


def test_turning_on_the_spot() -> None:
    states, _ = walk(scene_of(), lambda i: Command(turn=-1.0) if i < 6 else Command(), 10)
    assert states[6, 2] < -2.0
    np.testing.assert_allclose(states[:, :2], 0.0, atol=1e-9)
    assert states[-1, 5] == 0.0


@pytest.mark.parametrize("direction", [0.7, -1.5, math.pi, 7.0])
def test_a_direction_in_the_world_is_turned_to_and_walked(direction: float) -> None:
    states, _ = walk(scene_of(), Command(forward=1.0, direction=direction), 30)
    assert math.cos(states[-1, 2] - direction) > 0.999
    assert abs(states[-1, 2]) < 4.0  # the short way round
    way = states[-1, :2] - states[-8, :2]
    assert math.atan2(*way) == pytest.approx(math.atan2(math.sin(direction), math.cos(direction)), abs=0.05)


def test_side_steps_keep_the_front() -> None:
    states, _ = walk(scene_of(), Command(strafe=1.0), 20)
    np.testing.assert_allclose(states[:, 2], 0.0, atol=1e-9)
    assert states[-1, 0] > 1.5
    np.testing.assert_allclose(states[-1, 4], MOTION.strafe_speed)


def random_scene(rng: np.random.Generator) -> Scene:
    boxes: list[Box] = []
    for _ in range(rng.integers(4, 30)):
        center, size = rng.uniform([-2.5, 0.0, -3.0], [2.5, 1.6, 5.0]), rng.uniform(0.1, [1.2, 1.5, 1.2])
        if math.hypot(center[0], center[2]) > 1.2:
            boxes.append((center.tolist(), size.tolist(), float(rng.uniform(-3.0, 3.0))))
    return scene_of(*boxes)


def random_command(rng: np.random.Generator) -> Command:
    side = float(rng.choice([-1.0, 1.0]))
    options = [
        FORWARD,
        Command(forward=1.0, run=True),
        Command(forward=-1.0),
        Command(),
        Command(turn=side),
        Command(forward=1.0, turn=0.7 * side),
        Command(strafe=side),
        Command(forward=0.7, strafe=0.7 * side),
        Command(forward=1.0, direction=float(rng.uniform(-3.0, 3.0))),
    ]
    return options[rng.integers(len(options))]


@pytest.mark.parametrize("seed", range(30))
def test_every_path_is_free_whatever_the_scene_and_the_user_do(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene, command, state = random_scene(rng), FORWARD, RootState()
    horizon, interval = int(rng.integers(3, 8)), float(rng.choice([0.1, 0.2, 0.3]))
    planner = RootPlanner(BODY, scene)
    for _ in range(25):
        command = random_command(rng) if rng.random() < 0.2 else command
        plan = planner.plan(Asked(state, command, horizon, interval))
        assert least_clearance(plan.path, scene) >= 0.0
        change = np.diff(world_velocities(plan.path.states), axis=0)
        assert np.max(np.linalg.norm(change, axis=1)) <= MOTION.braking * interval * 1.001
        assert np.max(np.abs(plan.path.states[:, 5])) <= MOTION.turn_rate + 1e-9
        # The next plan comes at any moment, as when the user lets go between two key frames.
        state = plan.path.at(float(rng.uniform(0.3, 2.0)) * interval)


def test_the_same_past_gives_the_same_path_bit_for_bit() -> None:
    scene = random_scene(np.random.default_rng(5))
    first, _ = walk(scene, FORWARD, 25)
    second, _ = walk(scene, FORWARD, 25)
    np.testing.assert_array_equal(first, second)


def test_reset_forgets_the_line_of_travel() -> None:
    planner = RootPlanner(BODY, scene_of())
    planner.plan(Asked(RootState(), FORWARD, HORIZON, INTERVAL))
    beside = RootState(x=0.3)
    back = planner.plan(Asked(beside, FORWARD, HORIZON, INTERVAL)).path.states[-1, 0]
    planner.reset()
    fresh = planner.plan(Asked(beside, FORWARD, HORIZON, INTERVAL)).path.states[-1, 0]
    assert back < 0.25
    assert fresh == pytest.approx(0.3, abs=1e-9)


def test_a_body_that_is_stuck_in_an_obstacle_stands_still() -> None:
    scene = scene_of(([0.0, 0.5, 2.0], [1.0, 1.0, 1.0], 0.0))
    plan = RootPlanner(BODY, scene).plan(Asked(RootState(z=2.0, forward=1.0), FORWARD, HORIZON, INTERVAL))
    assert plan.kind is RootPlanKind.STOPPED
    np.testing.assert_array_equal(plan.path.states[:, :3], np.tile([0.0, 2.0, 0.0], (HORIZON + 1, 1)))


def test_a_small_and_a_tall_body_find_their_own_way() -> None:
    gap = scene_of(wall(2.0, -4.0, -0.19), wall(2.0, 0.19, 4.0))
    for height, passes in ((1.2, True), (1.95, False)):
        body = proportional_humanoid(height)
        planner, state = RootPlanner(body, gap), RootState()
        for _ in range(30):
            plan = planner.plan(Asked(state, FORWARD, HORIZON, INTERVAL))
            assert least_clearance(plan.path, gap, body) > 0.0
            state = RootState(*plan.path.states[1].tolist())
        assert (state.z > 3.0) == passes


def test_who_has_no_patience_is_offered_in_several_plans_what_the_patient_are_in_one() -> None:
    """One stands before a wall: ways out are looked for from eighteen places, and there is none."""
    before_wall, asked = scene_of(wall(2.0, -3.0, 3.0)), Asked(RootState(z=1.6), FORWARD, 12, 0.15)
    patient = [plan.kind for plan in RootPlanner(BODY, before_wall).candidates(asked)]
    looked_at: list[int] = []

    def enough(checks: int) -> bool:
        looked_at.append(checks)
        return len(looked_at) % 4 == 0

    planner, plans, offered = RootPlanner(BODY, before_wall), 0, list[RootPlanKind]()
    while len(offered) < len(patient):
        offered = [plan.kind for plan in planner.candidates(asked, patience=Patience(enough=enough))]
        plans += 1
    assert offered == patient
    assert plans == 1 + len(looked_at) // 4 > 2
    assert min(looked_at) > 0
