"""Where the hips are in the world, before the waist turns them: the frame that the upper body is planned in."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.frames import place_frame
from elbowroom.body.root import HEIGHT
from elbowroom.jit import inner_kernel, kernel

Floats = NDArray[np.float64]


@inner_kernel
def place_hips(root: Floats, hips: Floats, sink: Floats, rotations: Floats, places: Floats, joint: int) -> None:
    """The hips' frame in the world, into row `joint`: T-pose hips in the root's frame, `sink` (2,) below and behind."""
    c, s = np.cos(root[2]), np.sin(root[2])
    ahead = hips[2] - sink[1]
    x, z = root[0] + hips[0] * c + ahead * s, root[1] - hips[0] * s + ahead * c
    height = hips[1] - sink[0]
    if len(root) > HEIGHT:
        height += root[HEIGHT]
    place_frame(joint, rotations, places, x, height, z, root[2])


@inner_kernel
def place_pelvis_into(
    hips: Floats, roots: Floats, sinks: Floats, count: int, places: Floats, rotations: Floats
) -> None:
    """`place_pelvis` for the first `count` roots, written to `places` (N, 3) and `rotations` (N, 4)."""
    for n in range(count):
        place_hips(roots[n], hips, sinks[n], rotations, places, n)


@kernel
def place_pelvis(hips: Floats, roots: Floats, sinks: Floats) -> tuple[Floats, Floats]:
    """Pelvis frames in the world: places (N, 3) and rotations (N, 4)."""
    places, rotations = np.empty((len(roots), 3)), np.empty((len(roots), 4))
    place_pelvis_into(hips, roots, sinks, len(roots), places, rotations)
    return places, rotations
