"""A humanoid's upper body in a scene: its posture sets, what was computed of late, and what is tried for a root path.

Each group by itself, then the waist held to the last plan's way, then all groups together (`dressing`). If there is no
way then, postures are added where it was blocked, and it is tried again.
"""

from collections.abc import Iterator
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.clip import MotionClip
from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, columns_of, limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.exact.group.caches import PlanCaches, begin_root_sweeps
from elbowroom.planning.exact.group.path_problem import PathProblem
from elbowroom.planning.exact.group.problem import Group, Weights
from elbowroom.planning.exact.lattice.closed_edges import new_closed_edges
from elbowroom.planning.exact.lattice.lattice import EXTRA, Work, new_work
from elbowroom.planning.exact.lattice.postures import Postures, postures_of
from elbowroom.planning.exact.memory.own_contacts import OwnContacts
from elbowroom.planning.exact.memory.previous_plan import Asked, PreviousPlan, Start, clearances
from elbowroom.planning.exact.plan.upper_body_search import UpperBodySearch
from elbowroom.planning.exact.refine.blocked import arms_for, waists_for
from elbowroom.planning.exact.refine.sampling import Pool, RefinementSettings, drawn_postures
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.sweep.motion_bounds import chain_of, levers_of, new_limb_sweeps, new_root_sweeps
from elbowroom.planning.exact.sweep.node_clearances import new_node_clearances
from elbowroom.planning.exact.sweep.own_body import OwnBody
from elbowroom.planning.exact.sweep.own_motion import OwnMotion
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.limb import Limb, limb_of, pose
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.model.self_contact import clear_of_trunk
from elbowroom.planning.motion import GoOn, keep_going
from elbowroom.planning.paper.activity_graph import ActivityGraph
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath, ground_covered
from elbowroom.world.obstacles.along import Along
from elbowroom.world.obstacles.moving import Moving
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_NEARLY = 0.5  # metres: more than any margin
_CACHED, _MASKS = 8, 2  # times the horizon: results of key intervals that are kept, and closed steps of some of them
_SPARE = 0.05  # metres


class Effort(Enum):
    """What is tried before it is said that there is no way."""

    __hash__ = object.__hash__  # as `DofGroup` has it

    QUICK = "quick"  # the groups one after the other
    GLANCE = "glance"  # then all together, at first sight
    JOINT = "joint"  # then all together
    REFINED = "refined"  # then with more postures


class UpperPlan(NamedTuple):
    """A local plan and how far it got."""

    plan: LocalPlan
    reached: int  # n if found, else the deepest key time with a way for every group
    search: UpperBodySearch  # the last attempt, which can say why there is no way
    asked: Asked | None = None  # what clearances were asked for; None unless found


class UpperBodyPlanner:
    """A humanoid's upper body in a scene: posture sets for a key interval, made once, and what was computed of late."""

    def __init__(
        self,
        humanoid: Humanoid,
        scene: Scene,
        settings: ExactSettings,
        motions: MotionSet = STOCK,
    ) -> None:
        self.settings = settings
        self.version = 0  # greater after every change of a group's posture set
        self.goals = natural_walk(motions)
        self._model = body_model(humanoid)
        self._limbs = {group: limb_of(self._model, group) for group in LOCAL_GROUPS}
        self._points = {group: _points(limb, motions.clips(group), settings) for group, limb in self._limbs.items()}
        self._weights = Weights(
            settings.step_weight, settings.near_weight, settings.comfort, settings.keeping, settings.rounds
        )
        self._quick_weights = self._weights._replace(rounds=settings.quick_rounds)
        self._postures: dict[tuple[DofGroup, float], Postures] = {}
        self._shelves: dict[float, PlanCaches] = {}
        self._clearances: dict[float, Asked] = {}
        self.own_body, self._contacts = OwnBody(self._model, self.goals), OwnContacts()
        self._own_motion = OwnMotion(self._model, self.own_body.pairs)
        self._refinement = RefinementSettings()
        self._pools = {group: Pool(group.size, self._refinement.capacity) for group in LOCAL_GROUPS}
        self._reaches = {group: _reach(group, limb) for group, limb in self._limbs.items()}
        self._obstacles = scene.obstacles
        self._legs = LoweredLegs(self._model, scene.obstacles)
        self._prepare()

    def plan(
        self,
        path: RootPath,
        begins: Start,
        previous: PreviousPlan | None = None,
        others: Moving | None = None,
        effort: Effort = Effort.REFINED,
        go_on: GoOn = keep_going,
    ) -> UpperPlan:
        """Motion along `path` from where it `begins`, near the `previous` plan; `others` move besides the scene's.

        `go_on` is called before each search, and raises an exception to call the plan off.
        """
        near = self._near(path, others)
        legs = self._legs.among(others, path)
        rounds = {Effort.QUICK: 0, Effort.GLANCE: 1}.get(effort, self.settings.guided_rounds)
        weights = self._quick_weights if effort in (Effort.QUICK, Effort.GLANCE) else self._weights
        for attempt in range(self.settings.refinements + 1):
            search = self._dressing(path, begins, previous, near, legs, weights, go_on)
            between = 0 < attempt < self.settings.refinements  # postures were added, and may be added once more
            found = search.motion(0 if between else rounds)
            if found is not None:
                return UpperPlan(found, path.horizon, search, search.asked)
            if effort is not Effort.REFINED or attempt == self.settings.refinements or not self._refine(search):
                break
        evidence_log, goals = search.evidence_log, search.goals
        plan = LocalPlan(PlanStatus.EXHAUSTED, goals[:0], goals, evidence_log.evidence(), joint=evidence_log.joint)
        return UpperPlan(plan, search.deepest, search)

    def _near(self, path: RootPath, others: Moving | None) -> Along:
        """What the upper body could reach on a path."""
        reach = self._shelves_for(path).span + _NEARLY
        low_x, high_x, low_z, high_z = ground_covered(path.states)
        ground = (low_x - reach, low_z - reach), (high_x + reach, high_z + reach)
        return self._obstacles.along(path.times, ground, others)

    def reset(self) -> None:
        """Forget the postures that were added, and what was computed of late."""
        self._contacts.forget()
        self._shelves.clear()
        for group, pool in self._pools.items():
            if pool.clear():
                self._take_in(group)
        self._prepare()

    def _prepare(self) -> None:
        """Make what the first plan would have to wait for: empty shelves, and which postures run into the body."""
        interval = self.settings.interval
        horizon = round(self.settings.look_ahead / interval)
        self._shelves[interval] = self._new_shelves(interval, horizon)
        self._clearances[interval] = clearances(self.settings, interval, 2 * horizon)
        for side, group in enumerate(LOCAL_GROUPS[1:]):
            self.own_body.resting_costs(side, self.postures(group, interval), horizon + 1)

    def _dressing(
        self,
        path: RootPath,
        begins: Start,
        previous: PreviousPlan | None,
        near: Along,
        legs: LoweredLegs,
        weights: Weights,
        go_on: GoOn,
    ) -> UpperBodySearch:
        caches = self._shelves_for(path)
        goals = self.goals(path)
        roots = begin_root_sweeps(caches.held[DofGroup.WAIST], path.states, path.interval, near.stamps)
        self._contacts.begin(path.start_time)
        asked = self._asked(path, begins.ahead)
        problem = PathProblem.of(path, goals, previous, begins, roots, near, asked)
        parts = self.own_body, self._own_motion, self._contacts
        return UpperBodySearch(caches, weights, self.settings, *parts, legs, problem, go_on)

    def _refine(self, search: UpperBodySearch) -> bool:
        """Take in postures that are free where a group was blocked; whether there are any that were not known."""
        changed = {group for group, found in self._reaching(search) if self._pools[group].add(found)}
        for group in changed:
            self._take_in(group)
        return bool(changed)

    def _reaching(self, search: UpperBodySearch) -> Iterator[tuple[DofGroup, Floats]]:
        """Postures for the slices from the blocked one on: of the waist, and of the arm that was blocked."""
        blocked, failed = search.blocked_slice(), search.blocked[0]
        last = min(blocked.depth + self._refinement.slices, search.path.horizon + 1)
        for depth in range(blocked.depth, last):
            for number in sorted({0, failed}):
                group = LOCAL_GROUPS[number]
                here = blocked._replace(depth=depth, goal=search.goals[depth, columns_of(group)])
                limb, known = self._limbs[group], np.concatenate([self._points[group], self._pools[group].postures])
                if number == 0:
                    yield group, waists_for(limb, self._reaches[group], known, here, self._refinement)
                else:
                    reach = self._reaches[group]
                    yield group, arms_for(self.own_body, number - 1, limb, reach, known, here, self._refinement)

    def _take_in(self, group: DofGroup) -> None:
        """Link a group's postures anew; what was computed for its old set is forgotten."""
        self.version += 1
        for key in [key for key in self._postures if key[0] is group]:
            del self._postures[key]
        for interval, caches in self._shelves.items():
            self._shelves[interval] = caches.with_group(group, *self._shelf(group, interval, caches.horizon))

    def _shelf(self, group: DofGroup, interval: float, horizon: int) -> tuple[Group, Work]:
        count, postures = _CACHED * (horizon + 1), self.postures(group, interval)
        width, size = postures.moves.shape[1], group.size
        tables, ways = (
            new_node_clearances(count, size, width),
            new_limb_sweeps(count, size, carries=group is DofGroup.WAIST),
        )
        masks = new_closed_edges(_MASKS * (horizon + 1), size, width + EXTRA)
        speed, acceleration = self.settings.speed_of(group), self.settings.acceleration_of(group)
        levers = levers_of(self._model, postures.limb)
        made = Group(postures, levers, limits(group), speed, acceleration, tables, ways, masks)
        return made, new_work(horizon + 1, width + EXTRA)

    def _asked(self, path: RootPath, ahead: int) -> Asked:
        """Clearances of nodes and motion along a path that begins so many key intervals ahead."""
        until, known = ahead + path.horizon, self._clearances.get(path.interval)
        if known is None or known.motion_margins.shape[1] < until:
            known = self._clearances[path.interval] = clearances(self.settings, path.interval, 2 * until)
        return known.since(ahead, path.horizon)

    def _shelves_for(self, path: RootPath) -> PlanCaches:
        known = self._shelves.get(path.interval)
        if known is None or known.horizon < path.horizon:
            known = self._shelves[path.interval] = self._new_shelves(path.interval, path.horizon)
        return known

    def _new_shelves(self, interval: float, horizon: int) -> PlanCaches:
        made = {group: self._shelf(group, interval, horizon) for group in LOCAL_GROUPS}
        groups = {group: cache for group, (cache, _) in made.items()}
        works = {group: scratch for group, (_, scratch) in made.items()}
        reach = max(groups[arm].postures.reach for arm in LOCAL_GROUPS[1:])
        chain = chain_of(self._model, self._limbs[DofGroup.WAIST], reach)
        return PlanCaches.of(groups, works, new_root_sweeps(_CACHED * (horizon + 1)), chain, horizon)

    def postures(self, group: DofGroup, interval: float) -> Postures:
        """The posture set of a group for key frames `interval` seconds apart."""
        if (group, interval) not in self._postures:
            speed = self.settings.mean_speed_of(group)
            points = np.concatenate([self._points[group], self._pools[group].postures])
            postures = postures_of(self._limbs[group], points, speed * interval)
            self._postures[group, interval] = postures._replace(reach=self._reaches[group])
        return self._postures[group, interval]


def _reach(group: DofGroup, limb: Limb) -> float:
    """Farther from the limb's frame than any posture within the limits gets, metres."""
    ends = pose(limb, drawn_postures(group, np.zeros(group.size), 2048, 3.0)).transpose(0, 2, 1).reshape(-1, 3)
    return float(np.linalg.norm(ends, axis=1).max()) + float(limb.radii.max()) + _SPARE


def _points(limb: Limb, clips: tuple[MotionClip, ...], settings: ExactSettings) -> Floats:
    """The postures of a group: those of its clips that keep clear of the trunk."""
    samples = settings.samples_of(clips[0].group)

    def accept(configurations: Floats) -> NDArray[np.bool_]:
        return clear_of_trunk(pose(limb, configurations), limb.trunk, limb.allowed)

    return ActivityGraph.from_clips(clips, samples, 1.0, 1024, accept).vertices.copy()
