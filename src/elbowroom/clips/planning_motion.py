"""A recorded motion in the terms of planning: root states with their gait phase, configurations of the upper body."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import SPINE
from elbowroom.body.dof import ARMS, CHILDREN, DofGroup, Turning, clamp, side_by_side
from elbowroom.body.gait.cycle import GaitShape, foot_poses, gait_shape
from elbowroom.body.pose.posture_of import arm_angles, arm_directions, chest_rotation, waist_angles
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.clips.carried import carried
from elbowroom.clips.recorded_steps import legs_seen
from elbowroom.clips.root_track import RootTrack, root_track, seen_from_root
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PlanningMotion:
    """What planning keeps of a motion, and what it loses."""

    name: str
    frame_time: float  # seconds
    gait: GaitShape  # the legs of the figure
    track: RootTrack  # root states (F, 7) and strides
    groups: dict[DofGroup, Floats]  # (F, size) of each local group, within the limits
    carried: Floats  # (F, POSING) how hips and chest go beside that, see `carried`
    heights: Floats  # (F,) of the hips beside those over a straight standing leg, metres
    feet: Floats  # (F, 2, PATH) where feet are, see `legs_seen`
    spans: Floats  # (F, 2, SPAN) from hip to ankle
    trunk_error: Floats  # (F,) radians between the chest and what bend and twist make of it
    arm_error: Floats  # (F, 4) radians between the directions of left upper arm, forearm, right ...; and theirs

    def __len__(self) -> int:
        return len(self.track.states)


def planning_motion(motion: BodyMotion) -> PlanningMotion:
    """Bring a motion to the planning degrees of freedom."""
    track, gait = root_track(motion), gait_shape(motion.skeleton)
    turns = seen_from_root(motion, track.states)
    chest = turns[:, motion.index(next(bone for bone in reversed(SPINE) if bone in motion.bones))]
    waist = _waist(motion, gait, chest, track.states)
    planned = chest_rotation(waist)
    groups, errors = {DofGroup.WAIST: waist}, []
    back = quaternion.conjugate(planned)
    for group in CHILDREN:
        if group.value.turning is Turning.COLUMN:
            groups[group] = _column(motion, group, quaternion.multiply(back[:, None], turns))
    for group in ARMS:
        side = group.label.removesuffix("Arm")
        upper = quaternion.multiply(back, turns[:, motion.index(f"{side}UpperArm")])
        lower = quaternion.multiply(back, turns[:, motion.index(f"{side}LowerArm")])
        groups[group] = clamp(group, arm_angles(upper, lower, side))
        outwards = np.array([1.0 if side == "left" else -1.0, 0.0, 0.0])
        for rotation, direction in zip((upper, lower), arm_directions(groups[group], side), strict=True):
            errors.append(_angle(quaternion.rotate(rotation, outwards), direction))
    trunk_error = np.linalg.norm(quaternion.to_rotation_vector(quaternion.multiply(back, chest)), axis=1)
    beside = carried(motion, turns[:, 0], quaternion.multiply(chest, back))
    return PlanningMotion(
        motion.name, motion.frame_time, gait, track, groups, beside, *legs_seen(motion, gait),
        trunk_error, np.stack(errors, axis=1),
    )  # fmt: skip


def _waist(motion: BodyMotion, gait: GaitShape, chest: Floats, states: Floats) -> Floats:
    """Bend, twist and lowering (F, 3): how far the hips are below where the walking cycle has them."""
    _, drops = foot_poses(gait.legs, gait.scale, states)
    lowering = (motion.rest[0, 1] - motion.hips[:, 1] - drops) / gait.half_leg
    return clamp(DofGroup.WAIST, np.concatenate([waist_angles(chest), lowering[:, None]], axis=1))


def _column(motion: BodyMotion, group: DofGroup, turns: Floats) -> Floats:
    """Bend and twist (F, 2) of the last of a group's joints in a motion, for rotations (F, B, 4) since the parent's."""
    ends = [bone for bone in reversed(group.value.bones) if bone in motion.bones]
    return clamp(group, waist_angles(turns[:, motion.index(ends[0])])) if ends else np.zeros((len(turns), group.size))


def upper_body(motion: PlanningMotion) -> Floats:
    """The local groups side by side (m, LOCAL), in the order of the table."""
    return side_by_side(motion.groups)


def _angle(a: Floats, b: Floats) -> Floats:
    angles: Floats = np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))
    return angles
