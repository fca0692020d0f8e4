"""How an animation is laid out as a skeleton of nodes: root motion, rest pose, unit and up axis."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.export.animation import Animation
from elbowroom.export.formats import Layout, Rest, RootMotion
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.takes import Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_ARMS_DOWN = np.deg2rad(45.0)  # of the A-pose, below the horizontal


def take_of(animation: Animation, layout: Layout | None = None) -> Take:
    """The animation as a take: joints by their bones' names, below a node `root` where that carries the way.

    All rotations of the rest pose are the identity.
    """
    chosen = layout or Layout()
    skeleton = animation.skeleton
    turned = _rest_turns(skeleton, chosen.rest)
    offsets = _offsets(skeleton, turned)
    rotations = _since(animation.rotations, skeleton, turned)
    translations = np.tile(offsets, (len(animation), 1, 1))
    names, parents = skeleton.names, skeleton.parents
    translations[:, 0] = animation.hips
    if chosen.root_motion is RootMotion.HIPS:
        translations[:, 0], rotations[:, 0] = animation.hips_in_world()
    if chosen.root_motion is RootMotion.ROOT:
        names, parents = ("root", *names), np.concatenate([[-1], parents + 1])
        offsets = np.concatenate([np.zeros((1, 3)), offsets])
        rotations = np.concatenate([animation.turns()[:, None], rotations], axis=1)
        translations = np.concatenate([animation.places[:, None], translations], axis=1)
    axes = quaternion.about_axis(0, 0.5 * np.pi) if chosen.up == "z" else quaternion.IDENTITY
    return Take(
        animation.name,
        _tree(names, parents, quaternion.rotate(axes, offsets) / chosen.unit),
        1.0 / animation.fps,
        quaternion.multiply(quaternion.multiply(axes, rotations), quaternion.conjugate(axes)),
        quaternion.rotate(axes, translations) / chosen.unit,
    )


def tips(skeleton: Skeleton, layout: Layout) -> dict[str, Floats]:
    """For every joint without a joint below it: how far its bone reaches (3,), in the axes and unit of the layout.

    A hand, a foot and the last joint of a finger go on as the bone before them does, the head up to the crown.
    """
    axes = quaternion.about_axis(0, 0.5 * np.pi) if layout.up == "z" else quaternion.IDENTITY
    turned = _rest_turns(skeleton, layout.rest)
    found = {}
    for joint in set(range(len(skeleton.names))) - set(skeleton.parents.tolist()):
        end = quaternion.rotate(turned[joint], _reach(skeleton, joint))
        found[skeleton.names[joint]] = quaternion.rotate(axes, end) / layout.unit
    return found


def _reach(skeleton: Skeleton, joint: int) -> Floats:
    """How far (3,) the bone of a joint reaches in T-pose, metres."""
    bone = skeleton.names[joint]
    along: Floats = skeleton.positions[joint] - skeleton.positions[skeleton.parents[joint]]
    if bone in ("head", "jaw") or bone.endswith("Eye"):
        return np.array([0.0, 0.13 * skeleton.height, 0.0]) if bone == "head" else np.array([0.0, 0.0, 0.03])
    if bone.endswith(("Foot", "Toes")):
        return np.array([0.0, 0.0, 0.05 * skeleton.height])
    return (0.6 if bone.endswith("Hand") else 0.8) * along


def _rest_turns(skeleton: Skeleton, rest: Rest) -> Floats:
    """World rotations (J, 4) of the joints in the rest pose, since the T-pose."""
    turns = np.tile(quaternion.IDENTITY, (len(skeleton.names), 1))
    if rest is Rest.T:
        return turns
    for joint, (bone, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        if bone.endswith("UpperArm"):
            turns[joint] = quaternion.about_axis(2, -_ARMS_DOWN if bone.startswith("left") else _ARMS_DOWN)
        elif parent >= 0:
            turns[joint] = turns[parent]
    return turns


def _offsets(skeleton: Skeleton, turned: Floats) -> Floats:
    """Each joint's place (J, 3) from its parent in the rest pose; for the hips their place above the ground."""
    parents = skeleton.parents
    steps = skeleton.positions - np.where(parents[:, None] >= 0, skeleton.positions[parents], 0.0)
    return quaternion.rotate(turned[np.maximum(parents, 0)], steps)


def _since(rotations: Floats, skeleton: Skeleton, turned: Floats) -> Floats:
    """Local rotations (F, J, 4) since a rest pose that is turned (J, 4) from the T-pose, for those since the T-pose."""
    above = np.where(skeleton.parents[:, None] >= 0, turned[skeleton.parents], quaternion.IDENTITY)
    return quaternion.multiply(quaternion.multiply(above, rotations), quaternion.conjugate(turned))


def _tree(names: tuple[str, ...], parents: NDArray[np.int64], offsets: Floats) -> NodeTree:
    count = len(names)
    nothing = np.full(count, -1, dtype=np.int64)
    turns, ones = np.tile(quaternion.IDENTITY, (count, 1)), np.ones((count, 3))
    return NodeTree(names, np.asarray(parents, np.int64), np.arange(count), offsets, turns, ones, nothing, nothing)
