"""What others are told about an avatar's way: boxes round its legs and round the rest of it, moving as it is planned.

As far as key frames are known the boxes go with them, and then straight on for a while at the last velocity.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import BodyModel, posture_capsules
from elbowroom.control.body_check import configuration
from elbowroom.control.key_frame_queue import KeyFrames
from elbowroom.world.moving import MovingBoxes, Repeat, Track

Floats = NDArray[np.float64]

_BEYOND = 2.0  # seconds after the last key frame
_SPARE = 0.03  # metres: between key frames limbs may reach a little farther


def predicted(humanoid: Humanoid, model: BodyModel, keys: KeyFrames) -> MovingBoxes:
    """Two moving boxes that hold the avatar at its key frames; the first of these is shown now."""
    segments = posture_capsules(model, _postures(keys), keys.roots).astype(np.float64)
    radii = humanoid.capsules.radii[:, None, None]
    ends = segments.reshape(len(radii), 2, 3, -1)
    dx, dz = ends[:, :, 0] - keys.roots[:, 0], ends[:, :, 2] - keys.roots[:, 1]
    sine, cosine = np.sin(keys.roots[:, 2]), np.cos(keys.roots[:, 2])
    own = np.stack([dx * cosine - dz * sine, ends[:, :, 1], dx * sine + dz * cosine], axis=2)
    reach = np.abs(own) + radii[:, None]
    legs = humanoid.capsules.of(DofGroup.ROOT)
    rest = np.setdiff1d(np.arange(len(radii)), legs)
    times, places, yaws = _way(keys)
    tracks = []
    for name, part in (("legs", legs), ("body", rest)):
        low, high = float((own[part, :, 1] - radii[part]).min()), float((own[part, :, 1] + radii[part]).max())
        half = reach[part].max(axis=(0, 1, 3)) + _SPARE
        centers = np.stack([places[:, 0], np.full(len(times), 0.5 * (low + high)), places[:, 1]], axis=1)
        size = np.array([2.0 * half[0], high - low, 2.0 * half[2]])
        tracks.append(Track(f"{humanoid.name}: {name}", size, times, centers, yaws, Repeat.ONCE))
    return MovingBoxes(tuple(tracks))


def _postures(keys: KeyFrames) -> Floats:
    return np.array([configuration(root, upper) for root, upper in zip(keys.roots, keys.uppers, strict=True)])


def _way(keys: KeyFrames) -> tuple[Floats, Floats, Floats]:
    """Times (K,), places (K, 2) and headings (K,): those of the key frames, and one more straight on."""
    last = keys.roots[-1]
    sine, cosine = np.sin(last[2]), np.cos(last[2])
    velocity = np.array([last[3] * sine + last[4] * cosine, last[3] * cosine - last[4] * sine])
    times = np.append(keys.times, keys.times[-1] + _BEYOND)
    places = np.vstack([keys.roots[:, :2], last[:2] + _BEYOND * velocity])
    return times, places, np.append(keys.roots[:, 2], last[2])
