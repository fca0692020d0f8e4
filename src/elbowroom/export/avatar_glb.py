"""The avatar's own file with an animation for its nodes."""

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.rig import Rig
from elbowroom.export.animation import Animation
from elbowroom.export.formats import RootMotion
from elbowroom.formats.gltf_animating import NodeMotion, Stand, on_stands, with_animation
from elbowroom.geometry import quaternion

_NEUTRAL = 1e-9


def avatar_glb(animation: Animation, humanoid: Humanoid, root: RootMotion) -> bytes:
    """The file as a GLB in which the avatar moves, in metres, the ground at y = 0, facing +Z at heading 0.

    A file in other units or facing, or whose origin is not under the hips, is hung below a node that makes up for it.
    """
    glb, rig = humanoid.glb, humanoid.rig
    if glb is None or rig is None:
        raise ValueError("the avatar has no file")
    hips, rotations = animation.hips, animation.rotations.copy()
    if root is RootMotion.HIPS:
        hips, rotations[:, 0] = animation.hips_in_world()
    stands = [_stand(rig)] if _stands_elsewhere(rig) else []
    if root is RootMotion.ROOT:
        stands.insert(0, Stand("root", np.zeros(3), quaternion.IDENTITY, 1.0))
    glb, numbers = on_stands(glb, stands) if stands else (glb, [])
    turned = rig.node_rotations(rotations)
    motions = [NodeMotion(int(node), turned[:, joint]) for joint, node in enumerate(rig.nodes)]
    motions[0] = NodeMotion(int(rig.nodes[0]), turned[:, 0], rig.hips_position(hips))
    if root is RootMotion.ROOT:
        motions.insert(0, NodeMotion(numbers[0], animation.turns(), animation.places))
    return with_animation(glb, animation.name, 1.0 / animation.fps, motions)


def _stand(rig: Rig) -> Stand:
    """What puts the file's world into the root's frame."""
    return Stand("avatar", rig.to_model(np.zeros(3)), quaternion.about_axis(1, -rig.facing), rig.scale)


def _stands_elsewhere(rig: Rig) -> bool:
    return bool(abs(rig.facing) > _NEUTRAL or abs(rig.scale - 1.0) > _NEUTRAL or np.abs(rig.offset).max() > _NEUTRAL)
