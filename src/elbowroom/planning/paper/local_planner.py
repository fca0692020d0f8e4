"""The local planner: upper-body motion for a root path, group after group (paper, sections 3.1 and 5.1)."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.dof import ARMS, LOWERING, DofGroup, columns_of, followed, limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, chest_frames, pelvis_frames
from elbowroom.body.root import ROOT_STATE
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.frames import compose
from elbowroom.planning.model.limb import limb_of, pose, trunk_limb
from elbowroom.planning.model.self_contact import clear_of_trunk
from elbowroom.planning.paper import figure6
from elbowroom.planning.paper.activity_graph import ActivityGraph
from elbowroom.planning.paper.roadmap import PosedGraph, Roadmap
from elbowroom.planning.paper.trunk_places import TrunkPlaces
from elbowroom.planning.result import GroupEvidence, LocalPlan, PlanStatus, SearchResult
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.layout import Nearby, Spans
from elbowroom.world.obstacles.rows import seen_from
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
_NEARLY = 0.5  # metres: more than any margin
_GROUPS = (DofGroup.WAIST, *ARMS)  # the paper's J*, in its order; what else hangs on the waist follows it


@dataclass(frozen=True)
class GroupSettings:
    """How the activity graph of a group is made."""

    samples_per_clip: int  # k
    radius: float  # r, radians: also the farthest move from one key frame to the next


@dataclass(frozen=True)
class LocalPlannerSettings:
    """Settings of the local planner.

    The radii allow, with key frames 0.15 s apart, 2.7 rad/s at the waist and 3.3 rad/s over an arm's joints together:
    what a brisk swing of the arms and a quick but human evasion need. As nothing is checked between key frames, the
    margin grows with the way between them.
    """

    waist: GroupSettings = field(default=GroupSettings(samples_per_clip=6, radius=0.4))
    arm: GroupSettings = field(default=GroupSettings(samples_per_clip=10, radius=0.5))
    margin: float = 0.01  # metres of clearance that count as free while the root stands
    margin_of_way: float = 0.35  # what is added to it for each metre that the root moves to or from the key frame
    budget: int = 60_000  # collision checks for each group and plan
    capacity: int = 384  # vertices of a graph; a plan that begins with a full graph begins it anew

    def of(self, group: DofGroup) -> GroupSettings:
        """The settings of a local group."""
        return self.waist if group is DofGroup.WAIST else self.arm


class LocalPlanner:
    """Dresses root paths with upper-body motion: waist, then left arm, then right arm.

    Each arm hangs on the waist motion chosen before it, and no group is reconsidered: the first that finds no way ends
    the plan (decoupled planning, as in the paper). The activity graphs live here and grow from plan to plan; equal
    calls after `reset` give equal plans.
    """

    def __init__(
        self,
        humanoid: Humanoid,
        scene: Scene,
        settings: LocalPlannerSettings | None = None,
        motions: MotionSet = STOCK,
    ) -> None:
        self.settings = settings or LocalPlannerSettings()
        self._motions = motions.upright()
        self.goals = natural_walk(self._motions)
        self._model = body_model(humanoid)
        self._posed = {group: self._posed_graph(group) for group in _GROUPS}
        self._reach = self._upper_body_reach()
        self.use_scene(scene)

    def use_scene(self, scene: Scene) -> None:
        """Plan among the obstacles of another scene, with the same graphs."""
        self._obstacles = scene.obstacles

    @property
    def trunk(self) -> TrunkPlaces:
        """Where the trunk can pass in some posture of the waist's clips; the root goes round what it cannot."""
        limb = trunk_limb(self._model)
        graph = self.graph(DofGroup.WAIST)
        shown = graph.vertices[: graph.initial_size]
        upright_first = shown[np.argsort(np.linalg.norm(shown, axis=1), kind="stable")]
        places, _ = pelvis_frames(self._model, np.zeros((1, ROOT_STATE)))
        segments = pose(limb, upright_first) + np.tile(places[0], 2)[:, None].astype(np.float32)
        return TrunkPlaces(self._obstacles, segments, limb.radii)

    def reset(self) -> None:
        """Forget the vertices that searches have added."""
        for posed in self._posed.values():
            posed.graph.reset()

    def graph(self, group: DofGroup) -> ActivityGraph:
        """The activity graph of a local group."""
        return self._posed[group].graph

    def plan(self, path: RootPath, start: Floats, rng: np.random.Generator) -> LocalPlan:
        """Find motion along `path` that begins at `start` (LOCAL,), radians.

        `start` is taken as it is; every later key frame of the result keeps `margins(path)` from all obstacles.
        """
        goals = self.goals(path)
        configurations = goals.copy()
        evidence: list[GroupEvidence] = []
        positions, rotations = pelvis_frames(self._model, path.states)
        near = self._near(positions)
        obstacles = seen_from(near, positions, rotations)
        margins = self.margins(path)
        for group in _GROUPS:
            columns = columns_of(group)
            roadmap = self._roadmap(group, obstacles, start[columns])
            result = figure6.search(roadmap, goals[:, columns], rng, margins, self.settings.budget)
            evidence.append(_evidence(group, result))
            if result.status is not PlanStatus.FOUND:
                return LocalPlan(result.status, configurations[:0], goals, tuple(evidence))
            configurations[:, columns] = result.path
            if group is DofGroup.WAIST:
                obstacles = self._from_chest(near, positions, rotations, result.path)
        return LocalPlan(PlanStatus.FOUND, followed(configurations), goals, tuple(evidence))

    def margins(self, path: RootPath) -> Floats:
        """The clearance (n+1,) in metres that counts as free at each key time."""
        way = np.zeros(len(path.states) + 1)
        way[1:-1] = np.linalg.norm(np.diff(path.states[:, :2], axis=0), axis=1)
        longest: Floats = np.maximum(way[:-1], way[1:])
        return self.settings.margin + self.settings.margin_of_way * longest

    def _roadmap(self, group: DofGroup, obstacles: Spans, start: Floats) -> Roadmap:
        posed = self._posed[group]
        if posed.graph.full:
            posed.graph.reset()
        return Roadmap(posed, obstacles, start)

    def _from_chest(self, near: Nearby, positions: Floats, rotations: Floats, waist: Floats) -> Spans:
        """The obstacles in the chest frame at each key time, for the chosen waist motion (n+1, 3)."""
        chest_positions, chest_rotations = chest_frames(self._model, waist)
        return seen_from(near, *compose(positions, rotations, chest_positions, chest_rotations))

    def _near(self, pelvis: Floats) -> Nearby:
        """The obstacles that the upper body could reach, or nearly, at any key time."""
        reach, ground = self._reach + _NEARLY, pelvis[:, [0, 2]]
        return self._obstacles.near(ground.min(axis=0) - reach, ground.max(axis=0) + reach)

    def _posed_graph(self, group: DofGroup) -> PosedGraph:
        chosen, waist = self.settings.of(group), group is DofGroup.WAIST
        limb = trunk_limb(self._model) if waist else limb_of(self._model, group)

        def accept(configurations: Floats) -> NDArray[np.bool_]:
            return clear_of_trunk(pose(limb, configurations), limb.trunk, limb.allowed)

        clips, bounds = upright(self._motions.clips(group)), limits(group)
        if waist:
            bounds[LOWERING - group.at.start] = 0.0
        graph = ActivityGraph.from_clips(
            clips, chosen.samples_per_clip, chosen.radius, self.settings.capacity, accept, bounds
        )
        return PosedGraph(limb, graph)

    def _upper_body_reach(self) -> float:
        """No capsule of the upper body gets farther than this from the hips, metres."""
        waist = self._posed[DofGroup.WAIST]
        places, _ = chest_frames(self._model, waist.graph.vertices)
        shoulders = 2.0 * float(np.linalg.norm(places, axis=1).max())
        return max(waist.reach, *(shoulders + self._posed[group].reach for group in ARMS))


def upright(clips: tuple[MotionClip, ...]) -> tuple[MotionClip, ...]:
    """Those of a group's clips that do not lower the pelvis: the paper's avatar cannot."""
    if clips[0].group is not DofGroup.WAIST:
        return clips
    column = LOWERING - DofGroup.WAIST.at.start
    return tuple(clip for clip in clips if not clip.configurations[:, column].any())


def _evidence(group: DofGroup, result: SearchResult) -> GroupEvidence:
    return GroupEvidence(group, result.status, result.checks, result.nodes, result.enhanced, result.nanoseconds)
