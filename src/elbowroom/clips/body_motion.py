"""How a body moved: one rotation per bone since the T-pose, and where the hips were; free of the file it was in."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import PARENTS
from elbowroom.body.skeleton import Skeleton
from elbowroom.clips.floor import plane_below
from elbowroom.clips.take_figure import TakeFigure
from elbowroom.formats.takes import Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_JUMP, _TIMES = 0.25, 8.0  # radians that some joint turns by, and times the usual step: more is no motion


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """A figure in motion: metres, Y up, its T-pose facing +Z; frames at equal time steps."""

    name: str
    bones: tuple[str, ...]  # (B,) VRM 1.0 names, parents first, "hips" first
    rest: Floats  # (B, 3) joint positions in T-pose, the ground at y = 0
    frame_time: float  # seconds
    turns: Floats  # (F, B, 4) world rotation of each bone since the T-pose, xyzw
    hips: Floats  # (F, 3) the hips joint, the ground at y = 0
    soles: Floats  # (2, 2, 3) heel and toe of the left and the right foot in T-pose, on the ground

    def __len__(self) -> int:
        return len(self.turns)

    @property
    def times(self) -> Floats:
        """Seconds (F,) from the first frame."""
        times: Floats = np.arange(len(self), dtype=np.float64) * self.frame_time
        return times

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) * self.frame_time

    @property
    def skeleton(self) -> Skeleton:
        """The figure in T-pose."""
        parents = [-1, *(self.index(joint_chain(self.bones, bone)[-2]) for bone in self.bones[1:])]
        return Skeleton(self.bones, np.array(parents, dtype=np.int64), self.rest)

    def index(self, bone: str) -> int:
        """The place of a bone; raises ValueError where the figure lacks it."""
        return self.bones.index(bone)

    def turn(self, bone: str) -> Floats:
        """World rotations (F, 4) of a bone since the T-pose."""
        turns: Floats = self.turns[:, self.index(bone)]
        return turns

    def position(self, bone: str) -> Floats:
        """World positions (F, 3) of a bone's joint, metres."""
        chain = joint_chain(self.bones, bone)
        at = self.hips.copy()
        for above, below in pairwise(chain):
            step = self.rest[self.index(below)] - self.rest[self.index(above)]
            at = at + quaternion.rotate(self.turn(above), step)
        return at

    def sole_points(self) -> Floats:
        """World positions (F, 2, 2, 3) of heels and toes."""
        points = np.empty((len(self), 2, 2, 3))
        for i, side in enumerate(("left", "right")):
            foot = f"{side}Foot"
            ankle, turn, rest = self.position(foot), self.turn(foot), self.rest[self.index(foot)]
            for j in range(2):
                points[:, i, j] = ankle + quaternion.rotate(turn, self.soles[i, j] - rest)
        return points


def joint_chain(bones: tuple[str, ...], bone: str) -> list[str]:
    """The bones from the hips to `bone`, those that are present."""
    chain, above = [bone], PARENTS[bone]
    while above is not None:
        if above in bones:
            chain.append(above)
        above = PARENTS[above]
    return chain[::-1]


def body_motion(take: Take, figure: TakeFigure, *, floor_known: bool) -> BodyMotion:
    """The motion of a take's figure.

    `floor_known`: the ground is where the rest pose stands (glTF); otherwise it is where the lowest sole is.
    """
    nodes = np.array(list(figure.bones.values()))
    turns, places = take.world(nodes)
    to_up = figure.upright
    turned = quaternion.normalize(quaternion.multiply(to_up, turns))
    motion = BodyMotion(
        name=take.name,
        bones=figure.names,
        rest=figure.positions,
        frame_time=take.frame_time,
        turns=quaternion.multiply(turned, quaternion.conjugate(figure.turns)),
        hips=figure.unit * quaternion.rotate(to_up, places[:, 0]),
        soles=figure.soles,
    )
    floor = _rest_floor(take, figure) if floor_known else _walked_floor(motion)
    return without_calibration(replace(motion, hips=motion.hips - floor))


def _rest_floor(take: Take, figure: TakeFigure) -> Floats:
    """The ground in the file, by its rest pose: (3,) metres."""
    hips = take.tree.world_matrices(take.tree.rotations)[figure.bones["hips"], :3, 3]
    height = figure.unit * float(quaternion.rotate(figure.upright, hips)[1]) - figure.hips_height
    return np.array([0.0, height, 0.0])


def _walked_floor(motion: BodyMotion) -> Floats:
    """The ground under the hips (F, 3), so that the lowest soles stand on it: captured floors are seldom level."""
    if not len(motion):
        return np.zeros(3)
    soles = motion.sole_points().reshape(len(motion), -1, 3)
    lowest = soles[np.arange(len(soles)), soles[..., 1].argmin(axis=1)]
    floor = np.zeros_like(motion.hips)
    floor[:, 1] = plane_below(lowest, motion.hips)
    return floor


def without_calibration(motion: BodyMotion) -> BodyMotion:
    """The motion without a first frame that is a pose by itself: many recordings begin with one in the T-pose."""
    if len(motion) < 4:
        return motion
    first = motion.turns[:6]
    steps = quaternion.angle_between(first[1:], first[:-1]).max(axis=1)
    if steps[0] < _JUMP or steps[0] < _TIMES * float(np.median(steps[1:])):
        return motion
    return replace(motion, turns=motion.turns[1:], hips=motion.hips[1:])
