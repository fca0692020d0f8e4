"""A recorded motion on an avatar of ours: every joint turns as its bone did, the feet stand where they stood.

Rotations are taken over as rotations since the T-pose in world axes, so that skeletons with more or fewer joints agree
on what can be seen: a joint that only one of the two has takes its part of the way between its neighbours.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import SPINE
from elbowroom.body.gait.cycle import gait_shape
from elbowroom.body.pose.hands import relaxed_rotations
from elbowroom.body.skeleton import Skeleton
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SkeletonMotion:
    """An avatar's joints over time."""

    frame_time: float  # seconds
    rotations: Floats  # (F, J, 4) normalised local rotations; the hips' own is in world axes
    hips: Floats  # (F, 3) the hips joint in the world, metres, the ground at y = 0
    scale: float  # the avatar's hips height by the figure's

    def __len__(self) -> int:
        return len(self.rotations)


def retarget(motion: BodyMotion, skeleton: Skeleton) -> SkeletonMotion:
    """Play a motion on a skeleton."""
    turns = _turns(motion, skeleton)
    local = turns.copy()
    relaxed = relaxed_rotations(skeleton)
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            local[:, joint] = quaternion.multiply(quaternion.conjugate(turns[:, parent]), turns[:, joint])
        if _is_finger(skeleton.names[joint]) and skeleton.names[joint] not in motion.bones:
            local[:, joint] = relaxed[joint]
    scale = float(skeleton.positions[0, 1]) / float(motion.rest[0, 1])
    hips = scale * motion.hips
    own = _on_skeleton(skeleton, turns, hips, motion)
    hips[:, 1] += scale * _lowest(motion) - _lowest(own)
    return SkeletonMotion(motion.frame_time, local, hips, scale)


def _is_finger(bone: str) -> bool:
    return any(finger in bone for finger in ("Thumb", "Index", "Middle", "Ring", "Little"))


def _turns(motion: BodyMotion, skeleton: Skeleton) -> Floats:
    """World rotations (F, J, 4) since the T-pose of the avatar's joints."""
    turns = np.empty((len(motion), len(skeleton.names), 4))
    spine = [bone for bone in SPINE if skeleton.has(bone)]
    for joint, (bone, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        if bone in spine:
            turns[:, joint] = _spine_turn(motion, (spine.index(bone) + 1) / len(spine))
        elif bone == "neck" and bone not in motion.bones:
            turns[:, joint] = quaternion.slerp(_spine_turn(motion, 1.0), motion.turn("head"), np.array(0.5))
        elif bone in motion.bones:
            turns[:, joint] = motion.turn(bone)
        else:
            turns[:, joint] = turns[:, parent]
    return turns


def _spine_turn(motion: BodyMotion, share: float) -> Floats:
    """The rotation (F, 4) at a part of the way from the hips to the figure's last spine bone."""
    chain = ["hips", *(bone for bone in SPINE if bone in motion.bones)]
    place = share * (len(chain) - 1)
    below = min(int(place), len(chain) - 2)
    if abs(place - round(place)) < 1e-9:
        return motion.turn(chain[round(place)])
    return quaternion.slerp(motion.turn(chain[below]), motion.turn(chain[below + 1]), np.array(place - below))


def _on_skeleton(skeleton: Skeleton, turns: Floats, hips: Floats, motion: BodyMotion) -> BodyMotion:
    """The same as the motion of the avatar's own joints and soles."""
    legs = gait_shape(skeleton).legs
    soles = np.empty((2, 2, 3))
    for i, side in enumerate(("left", "right")):
        ankle = skeleton.positions[skeleton.index(f"{side}Foot")]
        soles[i] = [[ankle[0], 0.0, ankle[2] - legs[i, 7]], [ankle[0], 0.0, ankle[2] + legs[i, 6]]]
    return BodyMotion(motion.name, skeleton.names, skeleton.positions, motion.frame_time, turns, hips, soles)


def _lowest(motion: BodyMotion) -> Floats:
    """Height (F,) of the lowest point of the soles."""
    lowest: Floats = motion.sole_points()[..., 1].min(axis=(1, 2))
    return lowest
