"""Plans that nobody asked for: past a box and before a wall, so that what is rarely needed is compiled and loaded.

Some of their parts can be had alone, without a plan: so that another process may compile them meanwhile.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np

from elbowroom.body.dof import LOCAL, DofGroup, columns_of
from elbowroom.body.fitting.slim_capsule import SlimSettings, slimmest
from elbowroom.body.gait.footholds import UNKNOWN, beside, onward, settled
from elbowroom.body.gait.gliding import gliding
from elbowroom.body.gait.living import body_of, living
from elbowroom.body.gait.stride import feet_standing, stride_length
from elbowroom.body.gait.tilted_foot import rolled
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, lower_body
from elbowroom.body.root import CARRIAGE, ROOT_STATE, RootState
from elbowroom.body.soles import PITCHES
from elbowroom.control.feet.feet_ahead import glides_ahead, steps_ahead
from elbowroom.control.shown.body_check import BodyCheck, Frames
from elbowroom.planning.command import Command
from elbowroom.planning.exact.group.own_contacts import rule_out_near
from elbowroom.planning.exact.joint.bounds import Problem
from elbowroom.planning.exact.joint.product import joint_path
from elbowroom.planning.exact.joint.reachability import next_triples
from elbowroom.planning.exact.lattice.postures import postures_of
from elbowroom.planning.exact.memory.previous_plan import StartState, jolts
from elbowroom.planning.exact.plan.ongoing import leads_to
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP, chain_of, new_limb_sweeps
from elbowroom.planning.exact.sweep.own_body import OwnBody
from elbowroom.planning.exact.sweep.own_body_nodes import OwnBodyTask, own_body_costs
from elbowroom.planning.exact.sweep.own_motion import OwnMotion, own_parts
from elbowroom.planning.exact.sweep.proof import Carrier, MovedLimb, limb_sweep
from elbowroom.planning.exact.sweep.scratch import new_scratch
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.model.levers import body_levers, levers_of
from elbowroom.planning.model.limb import limb_of
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.model.self_pairs import with_waist
from elbowroom.planning.narrow.build import build_of
from elbowroom.planning.narrow.gap import gap_ahead
from elbowroom.planning.narrow.goals import goals_where_narrow
from elbowroom.planning.narrow.places import NarrowPlaces
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.root.line.line import new_line
from elbowroom.planning.root.motion import go_as
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.ground.ground import heights_along, heights_beside
from elbowroom.world.obstacles.meshes.solids import inner_boxes
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Mesh
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.places.columns import surface_keys
from elbowroom.world.places.enclosed import enclosed
from elbowroom.world.places.layers import link_surfaces
from elbowroom.world.scene import Scene, on_ground

_INTERVAL, _HORIZON, _SPEED = 0.15, 8, 1.1  # seconds, key frames, m/s
_BESIDE = ((0.35, 1.0, 0.8), (0.1, 0.1, 0.1))  # centre and half size, metres: in the way of the left hand
_WALL = ((0.0, 1.5, 1.0), (3.0, 0.6, 0.1))  # legs pass, nobody else does
_LOW = ((0.1, 0.3, 1.2), (0.2, 0.3, 0.2))  # in the way of the legs
_JAMBS = [(-0.75, 1.0, 1.0), (0.75, 1.0, 1.0)]  # centres of two walls, half a metre apart
_SILL = (0.0, 0.05, 1.0), (0.5, 0.05, 0.5)  # the same of one that is stepped onto


@lru_cache(maxsize=4)
def rehearse(humanoid: Humanoid) -> None:
    """All of `REHEARSALS`, once for each humanoid."""
    for rehearsal in REHEARSALS.values():
        rehearsal(humanoid)


def rehearse_plans(humanoid: Humanoid) -> None:
    """Plan once each way, joint step, added postures and certificate included; and in the open."""
    path = _straight_on()
    for scene in (_scene_with(*_BESIDE), _scene_with(*_WALL), Scene.load("empty")):
        body = UpperBodyPlanner(humanoid, scene, ExactSettings())
        start = body.model.goals(path)[0]
        search = body.plan(path, StartState(start, np.zeros_like(start))).search
        if len(scene.obstacles):
            search.together(1)
            search.blockade()
    path.sample(path.times)
    jolts(start[None], start[None], 1)
    leads_to(path.states, start[None], start[None], 0, path.states[0], start, start)


def _straight_on() -> RootPath:
    states = np.zeros((_HORIZON + 1, ROOT_STATE))
    times = _INTERVAL * np.arange(_HORIZON + 1.0)
    states[:, 1], states[:, 3], states[:, 6] = _SPEED * times, _SPEED, 0.9 * times
    return RootPath(0.0, _INTERVAL, states)


def rehearse_own_body(humanoid: Humanoid) -> None:
    """Hold an arm, and a bent body in motion, against the rest of the avatar."""
    model, arm, path = body_model(humanoid), DofGroup.LEFT_ARM, _straight_on()
    body, count = OwnBody(model, natural_walk()), len(path.states)
    postures = postures_of(limb_of(model, arm), np.zeros((1, arm.size)), 1.0)
    previous, bent = np.zeros((count, arm.size)), np.full((count, LOCAL), 0.1)
    goals, around = np.zeros_like(bent), with_waist(bent[:, columns_of(DofGroup.WAIST)])
    rule_out_near(np.zeros(2, np.float32), previous[:1], previous[1:2], previous[0], 0.0)
    task = OwnBodyTask(previous, previous, previous[0], True, previous, goals, around, path.states)
    own_body_costs(body.own_body_nodes(arm, postures, body.resting(arm, postures)), task)
    OwnMotion(own_parts(model, body.pairs, body_levers(humanoid))).contacts(path, bent, np.zeros_like(bent), goals, 0)


def rehearse_detour(humanoid: Humanoid) -> RootPlan:
    """Plan root paths round a low box, aside of it, to a stand, with others about, on the spot; go on as told."""
    planner = RootPlanner(humanoid, _scene_with(*_LOW))
    start, horizon = RootState(0.0, 0.0, 0.0), 2 * _HORIZON
    for command in (Command(turn=1.0), Command()):
        planner.plan(Asked(start, command, horizon, _INTERVAL))
    list(planner.candidates(Asked(start, Command(forward=1.0), horizon, _INTERVAL)))
    planner.others = Scene.load("traffic").obstacles.moving
    list(planner.candidates(Asked(start, Command(forward=1.0), horizon, _INTERVAL)))
    planner.others = Moving()
    plan = planner.plan(Asked(start, Command(forward=1.0), horizon, _INTERVAL))
    go_as(plan.path.states.copy(), plan.path.states, _INTERVAL, planner.bounds)
    return plan


def rehearse_crouch(humanoid: Humanoid) -> None:
    """Hold the legs of a body that crouches on its way against a low box."""
    path, legs = _straight_on(), LoweredLegs(body_model(humanoid), _scene_with(*_LOW).obstacles)
    keys = np.full(len(path.states), 0.1)
    legs.blocked_intervals(path, keys, np.zeros_like(keys), 0.0)


def rehearse_narrow(humanoid: Humanoid) -> None:
    """Look for a gap between two walls, and for what one would like to do in it."""
    walls = Obstacles.boxes(_JAMBS, [[0.0, 0.0, 0.0, 1.0]] * 2, [[0.5, 1.0, 0.05]] * 2)
    scene, path = replace(Scene.load("empty"), obstacles=walls), _straight_on()
    narrow = NarrowPlaces(build_of(humanoid, body_model(humanoid)), scene.free_map)
    goals_where_narrow(narrow, path, natural_walk()(path))
    gap_ahead(narrow, new_line(RootState(), Command(forward=1.0), RootMotionSettings()), 0.0, 0.0, 0.0)


def rehearse_feet(humanoid: Humanoid) -> None:
    """Stand, glide, step and live, and look how feet will step and glide."""
    model, root = body_model(humanoid), np.zeros(ROOT_STATE)
    gait = model.gait
    row = gliding(gait, beside(gait, root), root, 0.01)
    settled(gait, onward(gait, row, root, 0.01))
    for ahead in (steps_ahead, glides_ahead):
        ahead(gait, row, np.concatenate([[0.1], root])[None], 0.1)
    feet_standing(1.0, root[None])
    stride_length(_SPEED)
    living(body_of(gait), np.concatenate([row, np.zeros(CARRIAGE)]), row, 0.01, 1.0, UNKNOWN)


def rehearse_shown(humanoid: Humanoid) -> None:
    """Look whether a step may be shown beside a box, while others move."""
    obstacles = replace(_one_box(*_BESIDE), moving=Scene.load("traffic").obstacles.moving)
    check, gait = BodyCheck(humanoid, replace(Scene.load("empty"), obstacles=obstacles)), body_model(humanoid).gait
    upper, feet = np.zeros(LOCAL), [beside(gait, RootState(0.0, z, 0.0).as_array()) for z in (0.0, 1.0)]
    shown = [np.concatenate([row, np.zeros(CARRIAGE)]) for row in feet]
    check.free_between(Frames((shown[0], shown[1]), (upper, upper), (0.0, 10.0)))
    check.room_along(feet[0][None], upper, 1.0)
    lower_body(gait, shown[0][None], upper[:1])


def rehearse_place() -> None:
    """Look a triangle over as if it were a place."""
    surface_keys(np.eye(3)[None], 1.0, (2, 2))
    cell = np.zeros(1, np.int64)
    enclosed(cell, np.zeros(1), np.eye(3)[None], 1.0, (2, 2))
    link_surfaces(cell, np.zeros(1), np.array([0, 1]), 1, 1, 0.1)


def rehearse_ground(humanoid: Humanoid) -> None:
    """Stand before a low box, put a foot elsewhere at once, and follow the ground onto it."""
    scene, upper = _scene_with(*_SILL), np.zeros(LOCAL)
    model, states = body_model(humanoid), np.zeros((1, ROOT_STATE))
    footing = Footing(model, scene.ground)
    footing.floors(footing.stood(states)[0])
    stands = np.concatenate([beside(model.gait, states[0]), np.zeros(CARRIAGE)])
    elsewhere = stands + 0.3 * (np.arange(len(stands)) == ROOT_STATE)
    BodyCheck(humanoid, scene).free_between(Frames((stands, elsewhere), (upper, upper), (0.0, 1.0)))
    heights_along(scene.ground, 0.0, np.array([[0.0, 0.0], [0.0, 1.0]]))
    heights_beside(scene.ground, 0.0, 0, np.zeros((2, 2, 2)))
    on_ground(scene, RootState())


def rehearse_way(humanoid: Humanoid) -> None:
    """Look for the way to a place."""
    here, goal = (0.0, 0.0, 0.0), (1.0, 0.0, 2.0)
    way = Navigator(humanoid, _scene_with(*_SILL)).find(here, goal)
    way.aim(here, 1.0)
    way.sees(here, goal)


def _scene_with(center: tuple[float, ...], half: tuple[float, ...]) -> Scene:
    return replace(Scene.load("empty"), obstacles=_one_box(center, half))


def _one_box(center: tuple[float, ...], half: tuple[float, ...]) -> Obstacles:
    return Obstacles.boxes([center], [[0.0, 0.0, 0.0, 1.0]], [half])


def rehearse_fit() -> None:
    """Fit a capsule, as avatars of one's own need many, and roll an average foot."""
    points = np.random.default_rng(0).normal(size=(9, 3))
    slimmest(points, points[0], points[1], SlimSettings(1.0, 0.0, 9))
    rolled(body_model(Humanoid.default()).gait.legs[0], PITCHES)


def rehearse_mesh() -> None:
    """Fill a closed mesh, as scenes with meshes do when they are read."""
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (1.0, 2.0) for z in (0.0, 1.0)])
    faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                      [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])  # fmt: skip
    inner_boxes(Mesh(corners, faces))


def rehearse_product() -> None:
    """Search a product of a few postures of each group that has a way, and one that has none."""
    depths, size = 3, 4
    costs, steps = np.zeros((depths, size), np.float32), np.zeros((depths - 1, size, size), np.float32)
    under = np.zeros((depths, size, size), np.float32)
    problem = Problem(costs, under, under, steps, steps, steps, np.ones(under.shape, np.bool_))
    joint_path(problem)
    joint_path(problem._replace(apart=np.zeros(under.shape, np.bool_)))
    next_triples(problem, 0, np.ones((size, size, size), np.bool_))


def rehearse_proof(humanoid: Humanoid) -> None:
    """Prove the way of a waist at rest, carried past a small box."""
    model = body_model(humanoid)
    limb = limb_of(model, DofGroup.WAIST)
    rest = np.zeros((1, DofGroup.WAIST.size))
    postures = postures_of(limb, rest, 1.0)
    ways, chain = new_limb_sweeps(1, DofGroup.WAIST.size, carries=True), chain_of(model, limb, postures.reach)
    places, turns, states = np.zeros((SWEEP + 1, 3)), np.zeros((SWEEP + 1, 4)), np.zeros(16)
    turns[:, 3], states[0] = 1.0, _INTERVAL
    carrier = Carrier(0, places, turns, np.full(SWEEP, 0.1), states, places, states)
    box = _one_box((postures.reach, 0.0, 0.0), (0.01, 0.01, 0.01)).standing
    ends = (rest[0], rest[0], rest[0], rest[0])
    moved = MovedLimb(postures, levers_of(model, limb), chain)
    limb_sweep(new_scratch(postures, chain.waist, box, 1), ways, moved, carrier, ends, box, 0.0)


# All of them, by names; those that take longest to compile come first.
REHEARSALS: dict[str, Callable[[Humanoid], object]] = {
    "plans": rehearse_plans,
    "proof": rehearse_proof,
    "detour": rehearse_detour,
    "own body": rehearse_own_body,
    "feet": rehearse_feet,
    "shown": rehearse_shown,
    "way": rehearse_way,
    "crouch": rehearse_crouch,
    "product": lambda _: rehearse_product(),
    "mesh": lambda _: rehearse_mesh(),
    "fit": lambda _: rehearse_fit(),
    "place": lambda _: rehearse_place(),
    "narrow": rehearse_narrow,
    "ground": rehearse_ground,
}
