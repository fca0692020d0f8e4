"""The Virtual Motion Capture protocol 3.1 as a performer speaks it: what a pose is in its messages.

Source: protocol.vmc.info. Receivers live in Unity's axes: left-handed, Y up, +Z ahead. What is in our world, and in the
axes of a file that faces +Z (VRM 1.0, glTF), is mirrored along X; what is in the axes of a file that faces -Z (VRM 0.x)
along Z: both give the same body (github.com/vrm-c/UniVRM, `Axes`).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.geometry import quaternion
from elbowroom.server.vmc.settings import Locomotion
from elbowroom.server.wire.pose import NodePose

Floats = NDArray[np.float64]
Message = tuple[str, tuple[Any, ...]]

_LOADED, _CALIBRATED, _NORMAL_MODE = 1, 3, 0
_ALONG_X, _ALONG_Z = np.array([-1.0, 1.0, 1.0]), np.array([1.0, 1.0, -1.0])
_BLINK_EVERY, _BLINK_LASTS = 4.0, 0.16  # seconds
# Unity calls the thumb's bones as VRM 0.x did.
_THUMB = {"ThumbMetacarpal": "ThumbProximal", "ThumbProximal": "ThumbIntermediate", "ThumbDistal": "ThumbDistal"}


@dataclass(frozen=True, eq=False)
class Puppet:
    """An avatar as receivers know it: they have loaded the same file."""

    bones: tuple[str, ...]  # (J,) Unity's names
    rest: Floats  # (J, 3) local translations of the bones' nodes, file axes and units
    humanoid: Humanoid
    mirror: Floats  # (3,) signs that bring the file's axes to Unity's

    @classmethod
    def of(cls, humanoid: Humanoid) -> "Puppet":
        """The puppet of an avatar; one without a file has its normalised skeleton."""
        skeleton, rig = humanoid.skeleton, humanoid.rig
        names = tuple(unity_name(bone) for bone in skeleton.names)
        if rig is None or humanoid.glb is None:
            parents = skeleton.parents
            rest = skeleton.positions - np.where(parents[:, None] >= 0, skeleton.positions[parents], 0.0)
            return cls(names, rest, humanoid, _ALONG_X)
        tree = read_nodes(parse_gltf(humanoid.glb, humanoid.name))
        faces_back = math.cos(rig.facing) < 0.0
        return cls(names, tree.translations[rig.nodes], humanoid, _ALONG_Z if faces_back else _ALONG_X)


@dataclass(frozen=True, eq=False)
class VmcMoment:
    """What is shown at one time."""

    time: float  # seconds
    place: tuple[float, float, float]  # the root in the world: x, height of the ground, z, metres
    heading: float  # radians
    pose: NodePose  # in the root's frame


def messages(puppet: Puppet, moment: VmcMoment, locomotion: Locomotion = Locomotion.ROOT) -> Iterator[Message]:
    """All messages of one frame: state, time, root, every bone with its place, and blinking."""
    yield "/VMC/Ext/OK", (_LOADED, _CALIBRATED, _NORMAL_MODE)
    yield "/VMC/Ext/T", (float(moment.time),)
    turn = quaternion.about_axis(1, moment.heading)
    hips, hips_turn = moment.pose.hips, moment.pose.rotations[0].astype(np.float64)
    if locomotion is Locomotion.ROOT:
        yield "/VMC/Ext/Root/Pos", ("root", *_mirrored(np.array(moment.place), turn, _ALONG_X))
    else:
        yield "/VMC/Ext/Root/Pos", ("root", *_mirrored(np.zeros(3), quaternion.IDENTITY, _ALONG_X))
        hips, hips_turn = _carried(puppet.humanoid, np.array(moment.place), moment.heading, (hips, hips_turn))
    for joint, bone in enumerate(puppet.bones):
        at = puppet.rest[joint] if joint else hips
        turned = moment.pose.rotations[joint] if joint else hips_turn
        yield "/VMC/Ext/Bone/Pos", (bone, *_mirrored(at, turned, puppet.mirror))
    yield "/VMC/Ext/Blend/Val", ("Blink", blink(moment.time))
    yield "/VMC/Ext/Blend/Apply", ()


def unity_name(bone: str) -> str:
    """A VRM 1.0 bone by its name among Unity's HumanBodyBones."""
    for new, old in _THUMB.items():
        if bone.endswith(new):
            bone = bone.removesuffix(new) + old
            break
    return bone[0].upper() + bone[1:]


def blink(time: float) -> float:
    """How far the eyes are closed (0 to 1): shut and opened again once every four seconds."""
    since = time % _BLINK_EVERY
    return max(0.0, 1.0 - abs(2.0 * since / _BLINK_LASTS - 1.0)) if since < _BLINK_LASTS else 0.0


def _mirrored(place: Floats, turn: Floats, mirror: Floats) -> tuple[float, ...]:
    """Place and rotation seen in a mirror, where turns about the axes in its plane go the other way."""
    x, y, z = mirror * place
    a, b, c = -mirror * turn[:3]
    return (float(x), float(y), float(z), float(a), float(b), float(c), float(turn[3]))


def _carried(humanoid: Humanoid, place: Floats, heading: float, hips: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    """The hips' own translation and rotation when they carry the way: as if the root stood still and they went."""
    rig, (at, turned) = humanoid.rig, hips
    if rig is None:
        turn = quaternion.about_axis(1, heading)
        return place + quaternion.rotate(turn, at), quaternion.multiply(turn, turned)
    turn = quaternion.about_axis(1, heading)
    in_world = place + quaternion.rotate(turn, rig.hips_in_root(at))
    above = rig.hips_parent_rotation  # turned by the heading in its own axes
    return rig.hips_position(in_world), quaternion.multiply(
        quaternion.multiply(quaternion.conjugate(above), quaternion.multiply(turn, above)), turned
    )
