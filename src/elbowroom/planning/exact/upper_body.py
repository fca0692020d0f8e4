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
from elbowroom.body.kinematics import body_model, chest_frames, pelvis_frames
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.activity_graph import ActivityGraph
from elbowroom.planning.exact.group_search import KEPT, OWN, GroupTask, GroupWay, search_group
from elbowroom.planning.exact.postures import Postures, postures_of
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.shown import Moments, moments_of
from elbowroom.planning.exact.slices import any_free
from elbowroom.planning.frames import compose
from elbowroom.planning.goal import goal_configurations, natural_walk
from elbowroom.planning.limb import Limb, limb_of, pose
from elbowroom.planning.motion import Lead
from elbowroom.planning.result import GroupEvidence, LocalPlan, PlanStatus
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.self_contact import clear_of_trunk
from elbowroom.world.boxes import tables_in_frames
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_NEARLY = 0.5  # metres: more than any margin
_DEARER = 0.5  # squared radians: what a waist posture costs more where an arm found no way under it
_ALIKE = 0.2  # radians: waist postures that are made dearer with it


class UpperPlan(NamedTuple):
    """A local plan and how far it got."""

    plan: LocalPlan
    reached: int  # n if found, else the deepest key time with a way for every group


class _Frames(NamedTuple):
    positions: Floats  # (M, 3) of the pelvis at the moments
    rotations: Floats  # (M, 4)
    boxes: Floats  # (B, 15) in the world


class UpperBody:
    """A humanoid's upper body in a scene: posture sets for a key interval, made once."""

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
        self._postures: dict[tuple[DofGroup, float], Postures] = {}
        self._boxes = scene.boxes.table
        self._box_radii = np.linalg.norm(self._boxes[:, 12:], axis=1)

    def plan(self, path: RootPath, start: Floats, lead: Lead, kept: Floats | None = None) -> UpperPlan:
        """Motion along `path` from `start` (11,), shown after `lead`; near `kept` (n+1, 11), the last plan's."""
        moments = moments_of(path, lead, self.settings.samples)
        postures = {group: self.postures(group, path.interval) for group in LOCAL_GROUPS}
        frames = self._frames(moments, postures)
        goals = goal_configurations(self.goals, path)
        before = goals if kept is None else kept
        ledger = _Ledger(moments, self.settings)

        def task(group: DofGroup, tables: Floats32) -> GroupTask:
            at = columns_of(group)
            return GroupTask(
                postures[group], tables, goals[:, at], before[:, at], start[at], lead.upper[at],
                lead.velocity[at],
            )  # fmt: skip

        waist_task = task(DofGroup.WAIST, tables_in_frames(frames.boxes, frames.positions, frames.rotations))
        extra = np.zeros((len(goals), len(waist_task.postures.configurations) + OWN))
        deepest = 0
        for attempt in range(self.settings.waist_rounds):
            keeping = attempt == 1 and kept is not None
            waist = ledger.search(DofGroup.WAIST, waist_task, _only_kept(extra) if keeping else extra)
            if waist.reached < path.horizon:
                deepest = max(deepest, waist.reached)
                if keeping:
                    continue
                break
            tables = self._chest_tables(frames, waist.shown)
            ways = [waist]
            for group in LOCAL_GROUPS[1:]:
                way = ledger.search(group, task(group, tables))
                if way.reached < path.horizon:
                    break
                ways.append(way)
            else:
                keys = np.concatenate([way.keys for way in ways], axis=1)
                return UpperPlan(LocalPlan(PlanStatus.FOUND, keys, goals, ledger.evidence()), path.horizon)
            deepest = max(deepest, way.reached)
            if not keeping:
                self._make_waist_yield(extra, waist_task, waist, postures[group], way.reached + 1, moments, frames)
        return UpperPlan(LocalPlan(PlanStatus.EXHAUSTED, goals[:0], goals, ledger.evidence()), deepest)

    def _make_waist_yield(
        self,
        extra: Floats,
        task: GroupTask,
        waist: GroupWay,
        arm: Postures,
        depth: int,
        moments: Moments,
        frames: _Frames,
    ) -> None:
        """Make waist postures dearer where an arm had no way, and rule out those that leave it none at all."""
        points = task.postures.configurations
        for near in range(max(depth - 1, 1), min(depth + 2, len(extra))):
            alike = np.linalg.norm(points - waist.keys[near], axis=1) < _ALIKE
            extra[near, : len(points)][alike] += _DEARER
            extra[near, len(points) :] += _DEARER
        candidates = np.flatnonzero(waist.free[depth])
        tables = self._tables_under(points[candidates], moments.lead + depth * moments.samples, frames)
        free = any_free(arm.segments, arm.limb.radii, tables, arm.reach, 0.0)
        extra[depth, candidates[~free]] = np.inf

    def _tables_under(self, waists: Floats, at: int, frames: _Frames) -> Floats32:
        """The boxes (F, B, 15) in the chest frames that waist postures (F, 3) would have at a moment."""
        places, turns = chest_frames(self._model, waists)
        here = np.full(len(waists), at)
        return tables_in_frames(frames.boxes, *compose(frames.positions[here], frames.rotations[here], places, turns))

    def _frames(self, moments: Moments, postures: Mapping[DofGroup, Postures]) -> _Frames:
        """The pelvis at the moments and the boxes that the upper body could reach from it, or nearly."""
        positions, rotations = pelvis_frames(self._model, moments.roots)
        waist = postures[DofGroup.WAIST]
        chests = float(np.linalg.norm(chest_frames(self._model, waist.configurations)[0], axis=1).max())
        reach = max(waist.reach, *(chests + postures[arm].reach for arm in LOCAL_GROUPS[1:])) + _NEARLY
        gaps = np.linalg.norm(self._boxes[:, None, :3] - positions, axis=2).min(axis=1, initial=np.inf)
        return _Frames(positions, rotations, self._boxes[gaps - self._box_radii < reach])

    def _chest_tables(self, frames: _Frames, waist: Floats) -> Floats32:
        places, turns = chest_frames(self._model, waist)
        return tables_in_frames(frames.boxes, *compose(frames.positions, frames.rotations, places, turns))

    def postures(self, group: DofGroup, interval: float) -> Postures:
        """The posture set of a group for key frames `interval` seconds apart."""
        if (group, interval) not in self._postures:
            speed = self.settings.waist_speed if group is DofGroup.WAIST else self.settings.arm_speed
            self._postures[group, interval] = postures_of(self._limbs[group], self._points[group], speed * interval)
        return self._postures[group, interval]


def _only_kept(extra: Floats) -> Floats:
    """Prices that hold the waist to the last plan's way while there is one."""
    prices = extra + _DEARER
    prices[:, len(prices[0]) - OWN + KEPT] = 0.0
    return prices


class _Ledger:
    """Searches one group after the other and keeps what each group's searches cost together."""

    def __init__(self, moments: Moments, settings: ExactSettings) -> None:
        self._moments, self._settings = moments, settings
        self._rows: dict[DofGroup, GroupEvidence] = {}

    def search(self, group: DofGroup, task: GroupTask, extra: Floats | None = None) -> GroupWay:
        """`search_group`, entered under `group`."""
        began = perf_counter_ns()
        way = search_group(task, self._moments, self._settings, extra)
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
