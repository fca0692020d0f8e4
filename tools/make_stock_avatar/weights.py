"""Skin weights: how much each bone moves each point, from smooth ramps across the joints.

A point's weights are a product of shares along the hierarchy (trunk or limb, then which segment of the limb), so a
bone only ever shares with its neighbours and the clothes bend as the skin below them does.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from make_stock_avatar.fields import Array
from make_stock_avatar.rest import BONES, INDEX, WRIST, finger_joints, joint

_FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
_SPINE_RAMPS = (("spine", 0.055), ("chest", 0.055), ("upperChest", 0.055), ("neck", 0.030), ("head", 0.022))


def ramp(at: Array, middle: float | Array, half: float) -> Array:
    """0 below middle - half, 1 above middle + half, smooth between."""
    t = np.clip((at - middle) / (2.0 * half) + 0.5, 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def body_weights(points: Array) -> Array:
    """Weights (N, J) of trunk, legs, arms, neck and head by place alone; rows sum to 1."""
    weights = np.zeros((len(points), len(BONES)))
    arm = arm_share(points)
    leg = leg_share(points)
    _spine(weights, points, (1.0 - arm) * (1.0 - leg))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        own = points * np.array([sign, 1.0, 1.0])
        _arm(weights, side, own, arm * (own[:, 0] > 0))
        _leg(weights, side, own, leg * ramp(own[:, 0], 0.0, 0.03))
    return weights


def arm_share(points: Array) -> Array:
    """How much a point belongs to an arm: a ramp through the shoulder joint that leans away from the flank."""
    x, y = np.abs(points[:, 0]), points[:, 1]
    return ramp(x + 1.1 * np.minimum(0.0, y - 1.385), 0.158, 0.072)


def leg_share(points: Array) -> Array:
    """How much a point belongs to a leg: a ramp through the hip joint, lower in the crotch."""
    x, y = np.abs(points[:, 0]), points[:, 1]
    middle = 0.868 + 0.035 * ramp(x, 0.09, 0.09)
    return ramp(-y, -middle, 0.075)


def _spine(weights: Array, points: Array, share: Array) -> None:
    above = np.ones(len(points))
    previous = "hips"
    x, y = np.abs(points[:, 0]), points[:, 1]
    for bone, half in _SPINE_RAMPS:
        step = ramp(y - 0.25 * points[:, 2] * (bone == "head"), joint(bone)[1], half)
        weights[:, INDEX[previous]] += share * above * (1.0 - step)
        above = above * step
        previous = bone
    weights[:, INDEX[previous]] += share * above
    clavicle = ramp(x, 0.085, 0.055) * ramp(y, 1.375, 0.05)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        own = clavicle * (points[:, 0] * sign > 0)
        for bone in ("upperChest", "neck"):
            moved = weights[:, INDEX[bone]] * own
            weights[:, INDEX[bone]] -= moved
            weights[:, INDEX[f"{side}Shoulder"]] += moved


def _arm(weights: Array, side: str, own: Array, share: Array) -> None:
    x = own[:, 0]
    elbow = ramp(x, joint("leftLowerArm")[0], 0.042)
    wrist = ramp(x, WRIST, 0.020)
    weights[:, INDEX[f"{side}UpperArm"]] += share * (1.0 - elbow)
    weights[:, INDEX[f"{side}LowerArm"]] += share * elbow * (1.0 - wrist)
    _hand(weights, side, own, share * elbow * wrist)


def _hand(weights: Array, side: str, own: Array, share: Array) -> None:
    """Splits the hand's share between the palm and the nearest fingers."""
    distances = np.column_stack([_distance_to_line(own, finger_joints(f)) for f in _FINGERS])
    distances[:, 0] -= 0.004
    nearest = np.exp(-(distances - distances.min(axis=1, keepdims=True)) / 0.0022)
    nearest /= nearest.sum(axis=1, keepdims=True)
    palm = share.copy()
    for i, finger in enumerate(_FINGERS):
        joints = finger_joints(finger)
        given = share * nearest[:, i]
        names = ("Metacarpal", "Proximal", "Distal") if finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
        halves = (0.012, 0.008, 0.005) if finger == "Thumb" else (0.009, 0.0055, 0.0045)
        for j, (name, half) in enumerate(zip(names, halves, strict=True)):
            axis = joints[j + 1] - joints[max(j - 1, 0)]
            along = (own - joints[j]) @ (axis / np.linalg.norm(axis))
            step = ramp(along, 0.0, half)
            if j == 0:
                given = given * step
                palm -= given
                left = given
            else:
                previous = f"{side}{finger}{names[j - 1]}"
                weights[:, INDEX[previous]] -= left * step
                left = left * step
            weights[:, INDEX[f"{side}{finger}{name}"]] += left
    weights[:, INDEX[f"{side}Hand"]] += palm


def _distance_to_line(points: Array, joints: Array) -> Array:
    best = np.full(len(points), np.inf)
    for a, b in pairwise(joints):
        axis = b - a
        u = np.clip((points - a) @ axis / (axis @ axis), 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(points - a - u[:, None] * axis, axis=1))
    return best


def _leg(weights: Array, side: str, own: Array, share: Array) -> None:
    knee = ramp(-own[:, 1], -joint("leftLowerLeg")[1], 0.050)
    weights[:, INDEX[f"{side}UpperLeg"]] += share * (1.0 - knee)
    weights[:, INDEX[f"{side}LowerLeg"]] += share * knee


def shoe_weights(points: Array) -> Array:
    """Weights (N, J) of shoes: shin above the ankle, foot, toes."""
    weights = np.zeros((len(points), len(BONES)))
    shin = ramp(points[:, 1], 0.108, 0.018)
    toes = ramp(points[:, 2], joint("leftToes")[2], 0.022) * (1.0 - shin)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        own = (points[:, 0] * sign > 0).astype(float)
        weights[:, INDEX[f"{side}LowerLeg"]] += own * shin
        weights[:, INDEX[f"{side}Toes"]] += own * toes
        weights[:, INDEX[f"{side}Foot"]] += own * (1.0 - shin - toes)
    return weights


def rigid(points: Array, bone: str) -> Array:
    """Weights (N, J) of something that one bone carries."""
    weights = np.zeros((len(points), len(BONES)))
    weights[:, INDEX[bone]] = 1.0
    return weights


def quantised(weights: Array) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The four strongest bones (N, 4) and their weights (N, 4) in 1/255, each row summing to 255; unused are 0."""
    joints = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    share = np.take_along_axis(weights, joints, axis=1)
    share = share / share.sum(axis=1, keepdims=True)
    whole = np.floor(share * 255.0 + 1e-6).astype(np.int64)
    whole[:, 0] += 255 - whole.sum(axis=1)
    joints = np.where(whole > 0, joints, 0)
    return joints.astype(np.uint8), whole.astype(np.uint8)
