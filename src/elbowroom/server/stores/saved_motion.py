"""A walk that a page has kept, as a file for other programs: what was shown there is what is written."""

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.export.animation import Animation, ShownPoses, check_length
from elbowroom.export.formats import FORMATS, Wishes
from elbowroom.export.writers import WRITERS, Exported
from elbowroom.geometry import quaternion

# Each frame is so many float32 numbers, little-endian: time, epoch (another one after a jump), x, y, z and heading of
# the root, the hips' translation (3), and the local rotations of the avatar's nodes (J, 4).
HEAD = 9
RATE = 60.0  # frames a second of what is written
MAX_FRAMES = 36_000  # ten minutes, as many as a page keeps
_LARGEST = 1e6  # of any number


def check_format(ending: str) -> None:
    """Raises `InputError` if no format has this ending."""
    if ending not in FORMATS:
        raise InputError(f"format: {ending[:20]!r}, there are {', '.join(FORMATS)}")


def save_motion(frames: bytes, humanoid: Humanoid, ending: str) -> Exported:
    """Write frames as a page sends them in the format with this ending; raises `InputError`."""
    check_format(ending)
    poses = _poses(frames, humanoid)
    check_length("motion", float(poses.times[-1] - poses.times[0]), humanoid, RATE)
    animation = Animation.of_poses("walk", humanoid.skeleton, poses, RATE)
    return WRITERS[ending](animation, humanoid, FORMATS[ending].layout(Wishes()))


def _poses(frames: bytes, humanoid: Humanoid) -> ShownPoses:
    joints = len(humanoid.skeleton.names)
    size = 4 * (HEAD + 4 * joints)
    if not frames or len(frames) % size or len(frames) > size * MAX_FRAMES:
        raise InputError(f"motion: {len(frames)} bytes, for this avatar 1 to {MAX_FRAMES} frames of {size} bytes")
    table = np.frombuffer(frames, "<f4").reshape(-1, HEAD + 4 * joints).astype(np.float64)
    if not (np.abs(table) < _LARGEST).all() or (np.diff(table[:, 0]) < 0.0).any():
        raise InputError("motion: the numbers are out of range, or time goes backwards")
    turns, hips = quaternion.normalize(table[:, HEAD:].reshape(-1, joints, 4)), table[:, 6:9]
    rig = humanoid.rig
    return ShownPoses(
        times=table[:, 0],
        jumps=np.diff(table[:, 1], prepend=table[0, 1]) != 0.0,
        rotations=turns if rig is None else rig.normalised(turns),
        hips=hips if rig is None else rig.hips_in_root(hips),
        places=table[:, 2:5],
        headings=table[:, 5],
    )
