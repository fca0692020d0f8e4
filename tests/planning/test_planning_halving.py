"""The one proof: against dense looks at all kinds of pairs, random intervals; and how far points move at most."""

from collections.abc import Callable
from dataclasses import replace

import coal
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, clamp, columns_of
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model, pelvis_frames, posture_capsules
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.control.others.neighbour import Neighbour, Walker
from elbowroom.control.shown.body_check import BodyCheck, Frames
from elbowroom.control.shown.standing_about import held_between, ways_between
from elbowroom.planning.exact.sweep.motion_bounds import stride_moves
from elbowroom.planning.halving import ENOUGH, begun, due, settle
from elbowroom.planning.model.levers import body_levers
from elbowroom.planning.root.path import interpolate_root
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene
from feet_walks import alive, path, random_wish, walked
from sampled import sampled
from shown_between import shown_ends

Floats = NDArray[np.float64]
DENSE = 2000  # looks in an interval
HUMANOID = proportional_humanoid(1.72)
MODEL = body_model(HUMANOID)
LEVERS = body_levers(HUMANOID)
RADII = HUMANOID.capsules.radii
FRAME = 1 / 60
WALKER = Walker(np.zeros(2), np.zeros(2))


def proven(ways: Floats, shares: Floats, each: int, depth: int) -> Floats:
    """What is proven of gaps (N, R) of points that go to and fro on lines, at increasing `shares` (N,)."""
    parts = each * 2

    def gaps_at(times: Floats) -> NDArray[np.float32]:
        return np.stack([np.interp(times, shares, way) for way in ways.T], axis=1).astype(np.float32)

    looks = np.concatenate([np.linspace(0.0, 0.5, each + 1), np.linspace(0.5, 1.0, each + 1)])
    lengths = np.empty((parts, ways.shape[1]))
    for b in range(parts):
        inside = np.linspace(b / parts, (b + 1) / parts, 50 * len(shares) + 1)
        rates = np.abs(np.diff(gaps_at(inside).astype(np.float64), axis=0)).max(axis=0) * (len(inside) - 1)
        lengths[b] = 1.01 * rates + 1e-6
    proof = begun(gaps_at(looks), lengths, each, ENOUGH, depth)
    found, where = np.empty(5, np.int64), np.empty(5)
    while (count := due(proof, found, where)) > 0:
        settle(proof, gaps_at((found[:count] + where[:count]) / parts), count)
    return np.asarray(proof.least.reshape(2, -1).min(axis=1))


@given(st.integers(0, 10**6), st.integers(1, 3), st.integers(1, 5))
def test_no_gap_is_less_than_what_is_proven(seed: int, each: int, depth: int) -> None:
    rng = np.random.default_rng(seed)
    shares = np.sort(np.concatenate([[0.0, 1.0], rng.uniform(0.0, 1.0, 4)]))
    ways = rng.uniform(-0.01, 0.1, (6, rng.integers(1, 4)))
    least = np.stack([np.interp(np.linspace(0, 1, DENSE + 1), shares, way) for way in ways.T]).min(axis=0)
    halves = least[: DENSE // 2 + 1].min(), least[DENSE // 2 :].min()
    bound = proven(ways, shares, each, depth)
    assert np.all((bound < ENOUGH) | (bound <= np.array(halves) + 1e-6))


def test_what_keeps_apart_is_proven_at_some_depth_and_what_touches_never() -> None:
    shares, ways = np.array([0.0, 0.2, 1.0]), np.array([[0.1, 0.002, 0.1]]).T
    assert proven(ways, shares, 1, 1).min() < ENOUGH
    assert proven(ways, shares, 1, 9).min() >= ENOUGH
    assert proven(ways - 0.002, shares, 1, 12).min() < ENOUGH


def random_roots(rng: np.random.Generator) -> tuple[Floats, Floats]:
    first = np.zeros(7)
    first[3:7] = rng.uniform(-1.0, 2.2), rng.uniform(-0.6, 0.6), rng.uniform(-2.0, 2.0), rng.uniform(0.0, 1.0)
    last = first.copy()
    last[1] += 0.15 * first[3]
    last[2] += 0.15 * first[5]
    last[3:6] += rng.uniform(-0.4, 0.4, 3)
    last[6] += rng.uniform(0.0, 0.25)
    return first, last


def random_upper(rng: np.random.Generator) -> Floats:
    upper = np.empty(LOCAL)
    for group in LOCAL_GROUPS:
        upper[columns_of(group)] = clamp(group, rng.uniform(-0.5, 1.0, group.size))
    return upper


def body_ends(roots: Floats, uppers: Floats) -> Floats:
    """The ends (C, 2, 3, N) of all capsules."""
    ends: Floats = posture_capsules(MODEL, np.hstack([roots[:, :3], uppers]), roots).astype(np.float64)
    return ends.reshape(len(ends), 2, 3, -1)


def longest(ends: Floats) -> Floats:
    """How far the end of each capsule (C,) that goes farther goes, along its way."""
    ways: Floats = np.linalg.norm(np.diff(ends, axis=3), axis=2).sum(axis=2).max(axis=1)
    return ways


def test_legs_move_no_farther_than_their_levers_say() -> None:
    rng, shares, legs = np.random.default_rng(0), np.linspace(0.0, 1.0, 301), MODEL.roots.indices
    nearest = 0.0
    for n in range(150):
        a, b = random_roots(rng)
        roots = np.array([interpolate_root(a, b, u, 0.15) for u in shares])
        roots[:, :3] = 0.0
        uppers, lowered = np.zeros((len(shares), LOCAL)), rng.uniform(0.0, 0.7, 2) * (n % 3 > 0)
        uppers[:, 2] = lowered[0] + shares * (lowered[1] - lowered[0])
        heights = pelvis_frames(MODEL, roots)[0].T
        ways = longest(body_ends(roots, uppers)[legs] - heights)
        stride = stride_moves(a, b, 0.15, 3).sum(axis=0)
        bounds = LEVERS.from_pelvis[legs, -3:] @ stride + LEVERS.from_pelvis[legs, 1] * np.ptp(lowered)
        assert np.all(ways <= bounds + 1e-4)
        nearest = max(nearest, float((ways[1:] / np.maximum(bounds[1:], 1e-3)).max()))
    assert nearest > 0.28  # the bound says something


def random_frames(rng: np.random.Generator) -> Frames:
    first, last = random_roots(rng)
    root, upper = first + FRAME / 0.15 * (last - first), random_upper(rng)
    return Frames((first, root), (upper, upper + rng.uniform(-0.1, 0.1, LOCAL)), (0.0, FRAME))


def on_feet(rng: np.random.Generator) -> Frames:
    """Two frames of a walk with feet of its own."""
    rows = walked(path(random_wish(int(rng.integers(1000))), 60 + int(rng.integers(120)), rng.uniform()))
    upper, (first, last) = random_upper(rng), rows[-2:].copy()
    last[:2] -= first[:2]
    first[:2] = 0.0
    return Frames((first, last), (upper, upper + rng.uniform(-0.1, 0.1, LOCAL)), (0.0, FRAME))


def carried(rng: np.random.Generator) -> Frames:
    """Two frames of a walk whose hips and trunk live."""
    rows = walked(path(random_wish(int(rng.integers(1000))), 60 + int(rng.integers(120)), rng.uniform()))
    upper, (first, last) = random_upper(rng), alive(rows)[-2:].copy()
    last[:2] -= first[:2]
    first[:2] = 0.0
    return Frames((first, last), (upper, upper), (0.0, FRAME))


def on_treads(rng: np.random.Generator) -> Frames:
    """Two frames of such a walk over ground that is not a plane."""
    frames = carried(rng)
    first, last = frames.roots
    first[RISES:ROOT_STATE] = rng.uniform(-0.2, 0.2, 4)
    last[RISES:ROOT_STATE] = first[RISES:ROOT_STATE] + rng.uniform(-0.05, 0.05, 4)
    last[HEIGHT] += rng.uniform(-0.02, 0.02)
    return frames


def between(frames: Frames, shares: Floats) -> Floats:
    """The ends (C, 2, 3, N) of all capsules in between."""
    return shown_ends(HUMANOID, np.stack(frames.roots), np.stack(frames.uppers), shares)


@pytest.mark.parametrize("drawn", [random_frames, on_feet, carried, on_treads])
def test_no_part_of_a_body_moves_farther_between_two_frames_than_is_said(
    drawn: Callable[[np.random.Generator], Frames],
) -> None:
    rng, nearest, check = np.random.default_rng(1), 0.0, BodyCheck(HUMANOID, Scene.load("empty"))
    for _ in range(60):
        frames = drawn(rng)
        ends = [check.axes(*each) for each in zip(frames.roots, frames.uppers, strict=True)]
        bounds = ways_between(check.soles.body, check.between(frames), frames.uppers, (ends[0], ends[1]))
        steps = np.linalg.norm(np.diff(between(frames, np.linspace(0.0, 1.0, 101)), axis=3), axis=2).max(axis=1)
        quickest = 100.0 * steps.max(axis=1)
        assert (quickest <= bounds + 1e-4).all()
        nearest = max(nearest, float((quickest / bounds).max()))
    assert nearest > 0.9


@pytest.mark.parametrize("drawn", [on_feet, carried, on_treads])
def test_no_foot_that_is_held_higher_moves_farther_than_is_said(
    drawn: Callable[[np.random.Generator], Frames],
) -> None:
    sill = {"type": "box", "center": [0.0, 0.05, 5.0], "size": [2.0, 0.1, 0.3]}
    check = BodyCheck(HUMANOID, Scene.of("sill", [sill], finish=(0.0, 9.0)))
    rng, shares = np.random.default_rng(1), np.linspace(0.0, 1.0, 101)
    assert len(check.soles.body.feet) > 0
    for _ in range(150):
        frames = drawn(rng)
        ends, pair = (
            [check.axes(*each) for each in zip(frames.roots, frames.uppers, strict=True)],
            check.between(frames),
        )
        held = held_between(check.soles.body, pair, frames.uppers, shares).astype(np.float64)
        steps = np.linalg.norm(np.diff(held.reshape(len(RADII), 2, 3, -1), axis=3), axis=2)
        quickest = 100.0 * steps.max(axis=(1, 2))
        assert (quickest <= ways_between(check.soles.body, pair, frames.uppers, (ends[0], ends[1])) + 1e-4).all()


def capsule(axis: Floats, radius: float) -> tuple[coal.Capsule, coal.Transform3s]:
    """A capsule of the other library about an axis (2, 3)."""
    along = axis[1] - axis[0]
    length = float(np.linalg.norm(along))
    turn = coal.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), along / length).toRotationMatrix()
    return coal.Capsule(float(radius), length), coal.Transform3s(turn, 0.5 * (axis[0] + axis[1]))


def judged(mine: Floats, theirs: Floats) -> float:
    """The least distance of two avatars' capsules (C, 2, 3, N), by coal."""
    least, result = np.inf, coal.DistanceResult()
    for n in range(mine.shape[3]):
        others = [capsule(axis, radius) for axis, radius in zip(theirs[..., n], RADII, strict=True)]
        for axis, radius in zip(mine[..., n], RADII, strict=True):
            shape, place = capsule(axis, radius)
            for other in others:
                least = min(least, coal.distance(shape, place, *other, coal.DistanceRequest(), result))
    return float(least)


@pytest.mark.parametrize("walks", sampled([True, False]))
def test_two_avatars_shown_as_free_of_each_other_are_so_between_the_frames(walks: bool) -> None:
    rng, shares, found = np.random.default_rng(2), np.linspace(0.0, 1.0, 41), [0, 0]
    check = BodyCheck(HUMANOID, Scene.load("empty"))
    for _ in range(25):
        frames, theirs = random_frames(rng), random_frames(rng)
        aside = rng.uniform(0.25, 0.9)
        for root in theirs.roots:
            root[0] += aside
        if not walks:
            theirs = theirs._replace(roots=(theirs.roots[0],) * 2, uppers=(theirs.uppers[0],) * 2)
        known = between(theirs, shares[:: len(shares) - 1])
        axes = known.reshape(len(RADII), 6, -1).transpose(2, 0, 1)
        check.others = (Neighbour(WALKER, Moving(), np.array([0.0, FRAME]), axes, RADII),)
        straight = known[..., :1] + shares * (known[..., 1:] - known[..., :1])
        least = judged(between(frames, shares), straight)
        free = check.free_between(frames)
        assert not free or least >= -2e-5
        assert free or least < 0.01
        found[int(free)] += 1
    assert min(found) >= 3


@pytest.mark.parametrize("drawn", [random_frames, on_feet])
def test_what_is_shown_beside_a_wall_is_free_between_the_frames(drawn: Callable[[np.random.Generator], Frames]) -> None:
    rng, shares, found = np.random.default_rng(3), np.linspace(0.0, 1.0, DENSE // 10), [0, 0]
    walls = Scene.load("a").obstacles
    check = BodyCheck(HUMANOID, Scene.load("a"))
    for _ in range(40):
        frames = drawn(rng)
        place = rng.uniform([-1.0, 0.5], [1.0, 6.0])
        for root in frames.roots:
            root[:2] += place
        axes = between(frames, shares).astype(np.float32).reshape(len(RADII), 6, -1)
        least, free = walls.clearance(axes, RADII.astype(np.float32), np.zeros(2), 0.0), check.free_between(frames)
        assert not free or least >= -2e-5
        assert free or least < 0.01
        found[int(free)] += 1
    assert min(found) >= 3


@pytest.mark.parametrize("phase", np.linspace(0.0, 0.9, 7))
def test_feet_that_pass_a_wall_by_five_millimetres_are_shown(phase: float) -> None:
    """While the walk slows down in a turn."""
    first = np.array([0.0, 0.0, 0.3, 0.96, 0.08, 2.07, phase])
    last = first + np.array([0.006, 0.014, 0.033, -0.048, -0.031, -0.233, 0.023])
    frames = Frames((first, last), (np.zeros(LOCAL), np.zeros(LOCAL)), (0.0, FRAME))
    axes = between(frames, np.linspace(0.0, 1.0, 30)).astype(np.float32).reshape(len(RADII), 6, -1)
    place = 1.5
    for _ in range(50):
        box = np.array([[place, 0.15, 0.0]]), np.array([[0.0, 0, 0, 1]]), np.array([[0.5, 0.15, 2.0]])
        check = BodyCheck(HUMANOID, replace(Scene.load("empty"), obstacles=Obstacles.boxes(*box)))
        least = Obstacles.boxes(*box).clearance(axes, RADII.astype(np.float32), np.zeros(2), 0.0)
        place -= least - 0.005
    assert 0.004 < least < 0.006
    assert check.free_between(frames)
