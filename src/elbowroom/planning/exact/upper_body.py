"""Waist, left arm and right arm along a root path, each by its own cheapest way.

The arms hang on the waist. Where the waist's way leaves an arm none, the waist yields: postures under which that arm
has no free posture at all are ruled out there, and the posture that failed becomes dearer; then all is planned anew.
Before that the waist's way of the last plan is tried, under which the arms had theirs.
"""

from collections.abc import Mapping
from time import perf_counter_ns
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.clip import MotionClip
from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import BodyModel, body_model, chest_frames
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.activity_graph import ActivityGraph
from elbowroom.planning.exact.crouch import ROUNDS, Crouch, node_lowerings
from elbowroom.planning.exact.group_search import (
    Group,
    GroupTask,
    GroupWay,
    Scratch,
    Weights,
    new_scratch,
    search_group,
)
from elbowroom.planning.exact.lattice import KEPT, OWN
from elbowroom.planning.exact.postures import Postures, postures_of
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.tables import any_free, new_tables
from elbowroom.planning.exact.ways import (
    SWEEP,
    Chain,
    LimbWays,
    RootWays,
    chain_of,
    levers_of,
    new_limb_ways,
    new_root_ways,
    root_ways,
)
from elbowroom.planning.frames import compose
from elbowroom.planning.goal import goal_configurations, natural_walk
from elbowroom.planning.limb import Limb, limb_of, pose
from elbowroom.planning.lowered_legs import LoweredLegs
from elbowroom.planning.result import GroupEvidence, LocalPlan, PlanStatus
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.self_contact import clear_of_trunk
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_NEARLY = 0.5  # metres: more than any margin
_DEARER = 0.5  # squared radians: what a waist posture costs more where an arm found no way under it
_ALIKE = 0.2  # radians: waist postures that are made dearer with it
_SHELVES = 8  # times the horizon: results of key intervals that are kept


class UpperPlan(NamedTuple):
    """A local plan and how far it got."""

    plan: LocalPlan
    reached: int  # n if found, else the deepest key time with a way for every group


class _Shelves(NamedTuple):
    """All that depends on the interval and the horizon."""

    groups: Mapping[DofGroup, Group]
    scratch: Mapping[DofGroup, Scratch]
    roots: RootWays
    chain: Chain


class UpperBody:
    """A humanoid's upper body in a scene: posture sets for a key interval, made once, and what was computed of late."""

    def __init__(
        self,
        humanoid: Humanoid,
        scene: Scene,
        settings: ExactSettings,
        motions: MotionSet = STOCK,
    ) -> None:
        self.settings = settings
        self.goals = natural_walk(motions)
        self._model = body_model(humanoid)
        self._limbs = {group: limb_of(self._model, group) for group in LOCAL_GROUPS}
        self._points = {group: _points(limb, motions.clips(group), settings) for group, limb in self._limbs.items()}
        self._weights = Weights(
            settings.step_weight, settings.near_weight, settings.comfort, settings.keeping, settings.rounds
        )
        self._postures: dict[tuple[DofGroup, float], Postures] = {}
        self._shelves: dict[tuple[float, int], _Shelves] = {}
        self._boxes = scene.boxes.table
        self._box_radii = np.linalg.norm(self._boxes[:, 12:], axis=1)
        self._legs = LoweredLegs(self._model, scene.boxes)

    def plan(self, path: RootPath, start: Floats, velocity: Floats, kept: Floats | None = None) -> UpperPlan:
        """Motion along `path` from `start` (11,) at `velocity` (11,); near `kept` (n+1, 11), the last plan's."""
        shelves = self._shelves_for(path)
        goals = goal_configurations(self.goals, path)
        before = goals if kept is None else kept
        ledger = _Ledger(shelves, self._weights)
        roots = root_ways(shelves.roots, shelves.chain, path.states, path.interval)
        boxes = self._near(path, shelves.chain)
        margins, skins = self._margins(path)

        def task(group: DofGroup, carriers: Longs, extra: Floats32) -> GroupTask:
            at = columns_of(group)
            return GroupTask(
                np.ascontiguousarray(goals[:, at]), np.ascontiguousarray(before[:, at]), start[at], velocity[at],
                margins, skins, extra, roots, carriers, boxes, path.interval,
            )  # fmt: skip

        waist_group = shelves.groups[DofGroup.WAIST]
        none = {group: _no_extra(shelves.groups[group], len(goals)) for group in LOCAL_GROUPS}
        extra = none[DofGroup.WAIST].copy()
        crouch = self._crouch(path, waist_group, goals, before, start)

        def waist_way(keeping: bool) -> GroupWay:
            for _ in range(ROUNDS):
                prices = _only_kept(extra) if keeping else extra
                way = ledger.search(DofGroup.WAIST, task(DofGroup.WAIST, roots, prices))
                if way.reached < path.horizon or not crouch.rules_out(way.keys, way.velocities, extra):
                    return way
            return way._replace(reached=0)

        deepest = 0
        for attempt in range(self.settings.waist_rounds):
            keeping = attempt == 1 and kept is not None
            waist = waist_way(keeping)
            if waist.reached < path.horizon:
                deepest = max(deepest, waist.reached)
                if keeping:
                    continue
                break
            ways = [waist]
            for group in LOCAL_GROUPS[1:]:
                way = ledger.search(group, task(group, waist.slots, none[group]))
                if way.reached < path.horizon:
                    break
                ways.append(way)
            else:
                keys = np.concatenate([way.keys for way in ways], axis=1)
                velocities = np.concatenate([way.velocities for way in ways], axis=1)
                plan = LocalPlan(PlanStatus.FOUND, keys, goals, ledger.evidence(), velocities=velocities)
                return UpperPlan(plan, path.horizon)
            deepest = max(deepest, way.reached)
            if not keeping:
                frames = _frames_at(shelves.roots, roots, way.reached + 1)
                _make_waist_yield(
                    self._model, extra, waist_group, waist, shelves.groups[group], way.reached + 1, frames, boxes
                )
        return UpperPlan(LocalPlan(PlanStatus.EXHAUSTED, goals[:0], goals, ledger.evidence()), deepest)

    def _crouch(self, path: RootPath, group: Group, goals: Floats, kept: Floats, start: Floats) -> Crouch:
        """What the legs say to the lowerings of the waist's nodes, in the order of their prices."""
        at, postures = columns_of(DofGroup.WAIST), group.postures
        lanes = np.zeros((postures.moves.shape[1], DofGroup.WAIST.size))
        lanes[: len(postures.configurations)] = postures.configurations
        return Crouch(self._legs, path, node_lowerings(lanes, goals[:, at], kept[:, at], start[at]))

    def _margins(self, path: RootPath) -> tuple[Floats, Floats]:
        """Clearances of nodes (n+1,) and of the motion in each interval (n,): less is asked for soon than later."""
        settings, times = self.settings, path.interval * np.arange(len(path.states))
        shares = np.minimum(settings.soon_share + (1.0 - settings.soon_share) * times / settings.soon, 1.0)
        return settings.margin * shares, settings.skin * shares[:-1]

    def _near(self, path: RootPath, chain: Chain) -> Floats:
        """The boxes that the upper body could reach, or nearly."""
        low, high = path.states[:, :2].min(axis=0), path.states[:, :2].max(axis=0)
        places = self._boxes[:, [0, 2]]
        gaps = np.linalg.norm(places - np.clip(places, low, high), axis=1)
        near: Floats = self._boxes[gaps - self._box_radii < chain.span + _NEARLY]
        return near

    def _shelves_for(self, path: RootPath) -> _Shelves:
        key = (path.interval, path.horizon)
        if key not in self._shelves:
            self._shelves[key] = self._new_shelves(*key)
        return self._shelves[key]

    def _new_shelves(self, interval: float, horizon: int) -> _Shelves:
        count = _SHELVES * (horizon + 1)
        groups, scratch = {}, {}
        for group in LOCAL_GROUPS:
            postures = self.postures(group, interval)
            width, size = postures.moves.shape[1], group.size
            groups[group] = Group(
                postures,
                levers_of(self._model, postures.limb),
                new_tables(count, size, width),
                new_limb_ways(count, size, carries=group is DofGroup.WAIST),
            )
            scratch[group] = new_scratch(horizon, width + OWN)
        reach = max(groups[arm].postures.reach for arm in LOCAL_GROUPS[1:])
        return _Shelves(
            groups, scratch, new_root_ways(count), chain_of(self._model, self._limbs[DofGroup.WAIST], reach)
        )

    def postures(self, group: DofGroup, interval: float) -> Postures:
        """The posture set of a group for key frames `interval` seconds apart."""
        if (group, interval) not in self._postures:
            speed = self.settings.waist_speed if group is DofGroup.WAIST else self.settings.arm_speed
            self._postures[group, interval] = postures_of(self._limbs[group], self._points[group], speed * interval)
        return self._postures[group, interval]


def _frames_at(ways: RootWays, roots: Longs, depth: int) -> tuple[Floats, Floats]:
    """The pelvis frame (3,), (4,) at a key time after the first."""
    at = roots[depth - 1]
    return ways.places[at, SWEEP], ways.turns[at, SWEEP]


def _make_waist_yield(
    model: BodyModel,
    extra: Floats32,
    group: Group,
    waist: GroupWay,
    arm: Group,
    depth: int,
    frame: tuple[Floats, Floats],
    boxes: Floats,
) -> None:
    """Make waist postures dearer where an arm had no way, and rule out those that leave it none at all."""
    points = group.postures.configurations
    width = extra.shape[1] - OWN
    for near in range(max(depth - 1, 1), min(depth + 2, len(extra))):
        alike = np.flatnonzero(np.linalg.norm(points - waist.keys[near], axis=1) < _ALIKE)
        extra[near, alike] += _DEARER
        extra[near, width:] += _DEARER
    candidates = np.flatnonzero(np.isfinite(waist.price[depth, : len(points)]))
    places, turns = chest_frames(model, points[candidates])
    count = len(candidates)
    chests = compose(np.tile(frame[0], (count, 1)), np.tile(frame[1], (count, 1)), places, turns)
    free = any_free(arm.postures, *chests, boxes)
    extra[depth, candidates[~free]] = np.inf


def _no_extra(group: Group, depths: int) -> Floats32:
    return np.zeros((depths, group.postures.moves.shape[1] + OWN), np.float32)


def _only_kept(extra: Floats32) -> Floats32:
    """Prices that hold the waist to the last plan's way while there is one."""
    prices = extra + np.float32(_DEARER)
    kept = extra.shape[1] - OWN + KEPT
    prices[:, kept] = np.where(np.isinf(extra[:, kept]), np.inf, 0.0)
    return prices


class _Ledger:
    """Searches one group after the other and keeps what each group's searches cost together."""

    def __init__(self, shelves: _Shelves, weights: Weights) -> None:
        self._shelves, self._weights = shelves, weights
        self._rows: dict[DofGroup, GroupEvidence] = {}

    def search(self, group: DofGroup, task: GroupTask) -> GroupWay:
        """`search_group`, entered under `group`."""
        began = perf_counter_ns()
        shelves = self._shelves
        waists: LimbWays = shelves.groups[DofGroup.WAIST].ways
        way: GroupWay = search_group(
            shelves.groups[group], shelves.roots, waists, shelves.chain, task, self._weights, shelves.scratch[group]
        )
        spent = perf_counter_ns() - began
        status = PlanStatus.FOUND if way.reached == len(task.goals) - 1 else PlanStatus.EXHAUSTED
        old = self._rows.get(group, GroupEvidence(group, status, 0, 0, 0, 0))
        checks, nodes, nanoseconds = old.checks + way.checks, old.nodes + way.nodes, old.nanoseconds + spent
        self._rows[group] = GroupEvidence(group, status, checks, nodes, 0, nanoseconds)
        return way

    def evidence(self) -> tuple[GroupEvidence, ...]:
        """A row for each group that was searched, in order."""
        return tuple(self._rows.values())


def _points(limb: Limb, clips: tuple[MotionClip, ...], settings: ExactSettings) -> Floats:
    """The postures of a group: those of its clips that keep clear of the trunk."""
    samples = settings.waist_samples if clips[0].group is DofGroup.WAIST else settings.arm_samples

    def accept(configurations: Floats) -> NDArray[np.bool_]:
        return clear_of_trunk(pose(limb, configurations), limb.trunk, limb.allowed)

    return ActivityGraph.from_clips(clips, samples, 1.0, 1024, accept).vertices.copy()
