"""All that the planner knows of an avatar's upper body before anybody walks: frozen, shared by all who walk as it.

It depends on the avatar, on its clips, on the settings and on the seconds between key frames, and on nothing else.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.dof import CHILDREN, LOCAL_GROUPS, DofGroup, limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model
from elbowroom.clips.motion_set import MotionSet
from elbowroom.planning.exact.lattice.drawing import drawn_postures
from elbowroom.planning.exact.lattice.postures import Postures, postures_of
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.sweep.motion_bounds import KinematicChain, chain_of
from elbowroom.planning.exact.sweep.own_body import OwnBody
from elbowroom.planning.exact.sweep.own_motion import OwnParts, own_parts
from elbowroom.planning.exact.sweep.scratch import ScratchShelf
from elbowroom.planning.goal import GoalFunction, natural_walk
from elbowroom.planning.model.levers import body_levers, levers_of
from elbowroom.planning.model.limb import Limb, limb_of, pose, trunk_limb
from elbowroom.planning.model.self_contact import clear_of_trunk
from elbowroom.planning.paper.activity_graph import ActivityGraph
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_SPARE = 0.05  # metres


class PostureSet(NamedTuple):
    """The postures of a group, how fast it may move between them, and which of them are of no use."""

    postures: Postures
    levers: Floats  # (C, 3) as `levers_of`
    limits: Floats  # (d, 2) of the joints, radians
    speed: float  # the greatest over all components together, rad/s, and
    acceleration: float  # rad/s^2
    resting: Bools  # (W,) which postures touch the naturally walking body
    scratch: ScratchShelf  # of the searches among them


@dataclass(frozen=True, eq=False)
class UpperBodyModel:
    """One avatar's upper body for one key interval."""

    settings: ExactSettings
    interval: float  # seconds between key frames
    body: BodyModel
    goals: GoalFunction  # of all local groups
    limbs: Mapping[DofGroup, Limb]
    points: Mapping[DofGroup, Floats]  # (V, d) the postures of the clips that keep clear of the trunk, radians
    reaches: Mapping[DofGroup, float]  # farther from a limb's frame than any posture within the limits gets, metres
    sets: Mapping[DofGroup, PostureSet]  # of the clips' postures
    trunk: Limb  # the waist's with all that follows the waist where nobody plans it, and
    trunk_reach: float  # as `reaches`
    chain: KinematicChain
    own_body: OwnBody
    own_parts: OwnParts

    @staticmethod
    def of(humanoid: Humanoid, motions: MotionSet, settings: ExactSettings, interval: float) -> "UpperBodyModel":
        """Measure an avatar that has learnt `motions`; takes a tenth of a second. `upper_body_model` shares it."""
        body, goals = body_model(humanoid), natural_walk(motions)
        limbs = {group: limb_of(body, group) for group in LOCAL_GROUPS}
        own_body = OwnBody(body, goals)
        points = {group: _points(own_body, limb, motions.clips(group), settings) for group, limb in limbs.items()}
        reaches = {group: _reach(group, limb) for group, limb in limbs.items()}
        chain = chain_of(body, limbs[DofGroup.WAIST], max(reaches[group] for group in CHILDREN))
        sets: dict[DofGroup, PostureSet] = {}
        parts = own_parts(body, own_body.pairs, body_levers(humanoid))
        trunk = trunk_limb(body)
        reach = _reach(DofGroup.WAIST, trunk)
        made = UpperBodyModel(
            settings, interval, body, goals, limbs, points, reaches, sets, trunk, reach, chain, own_body, parts
        )
        sets |= {group: made.set_of(group, points[group]) for group in LOCAL_GROUPS}
        return made

    def set_of(self, group: DofGroup, points: Floats) -> PostureSet:
        """The set of a group's postures `points` (V, d)."""
        settings, limb = self.settings, self.limbs[group]
        postures = postures_of(limb, points, settings.mean_speed_of(group) * self.interval)
        postures = postures._replace(reach=self.reaches[group])
        resting = np.zeros(postures.moves.shape[1], np.bool_)
        if group in CHILDREN:
            resting = self.own_body.resting(group, postures)
        speed, acceleration = settings.speed_of(group), settings.acceleration_of(group)
        scratch = ScratchShelf(postures, self.chain.waist)
        return PostureSet(postures, levers_of(self.body, limb), limits(group), speed, acceleration, resting, scratch)

    def trunk_set(self, waist: PostureSet) -> PostureSet:
        """The same postures of the waist, in the same order, with all that follows it as one limb."""
        return self._clips_trunk if waist is self.sets[DofGroup.WAIST] else self._trunk_set(waist)

    @cached_property
    def _clips_trunk(self) -> PostureSet:
        return self._trunk_set(self.sets[DofGroup.WAIST])

    def _trunk_set(self, waist: PostureSet) -> PostureSet:
        known = waist.postures
        postures = postures_of(self.trunk, known.configurations, known.step, ordered=True)
        postures = postures._replace(reach=self.trunk_reach)
        scratch = ScratchShelf(postures, self.chain.waist)
        return waist._replace(postures=postures, levers=levers_of(self.body, self.trunk), scratch=scratch)


_MODELS: Shared[UpperBodyModel] = Shared()


def upper_body_model(
    humanoid: Humanoid, motions: MotionSet, settings: ExactSettings, interval: float
) -> UpperBodyModel:
    """The model of an avatar that has learnt `motions`: the same one for all who ask, from any thread."""
    made_of = humanoid, motions, settings, interval
    return _MODELS.get(made_of, lambda: UpperBodyModel.of(humanoid, motions, settings, interval))


def _reach(group: DofGroup, limb: Limb) -> float:
    """Farther from the limb's frame than any posture within the limits gets, metres."""
    ends = pose(limb, drawn_postures(group, np.zeros(group.size), 2048, 3.0)).transpose(0, 2, 1).reshape(-1, 3)
    return float(np.linalg.norm(ends, axis=1).max()) + float(limb.radii.max()) + _SPARE


def _points(own: OwnBody, limb: Limb, clips: tuple[MotionClip, ...], settings: ExactSettings) -> Floats:
    """The postures of a group: those of its clips that keep clear of the trunk, or the trunk of the thighs."""
    samples = settings.samples_of(clips[0].group)

    def accept(configurations: Floats) -> Bools:
        if clips[0].group is DofGroup.WAIST:
            return ~own.folded(configurations)
        return clear_of_trunk(pose(limb, configurations), limb.trunk, limb.allowed)

    return ActivityGraph.from_clips(clips, samples, 1.0, 1024, accept).vertices.copy()
