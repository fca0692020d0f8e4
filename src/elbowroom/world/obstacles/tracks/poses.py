"""Where obstacles on tracks are at a time, for kernels."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import brief_exact_kernel, inner_exact_kernel
from elbowroom.world.obstacles.layout import CENTER, TURN

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

ONCE, LOOP, PINGPONG = range(3)  # what follows the last key pose


@by_reference
class Tracks(NamedTuple):
    """B tracks, one after the other."""

    starts: Longs  # (B+1,) where the key poses of each begin and end
    times: Floats  # (K,) seconds
    poses: Floats  # (K, 4) centre and yaw
    halves: Floats  # (B, 3) half lengths of a box about each that holds it, metres
    repeats: Longs  # (B,)


@inner_exact_kernel
def pose_at(times: Floats, poses: Floats, repeat: int, time: float, out: Floats) -> None:
    """The pose (4,) of one track, key poses (K, 4) at times (K,), at a time."""
    span, at = times[-1], time
    if span == 0.0 or repeat == ONCE:
        at = min(max(time, times[0]), span)
    elif repeat == LOOP:
        at = time % span
    else:
        at = span - abs(time % (2.0 * span) - span)
    k, last = 0, times.shape[0] - 1  # the key poses beside
    while last - k > 1:
        middle = (k + last) // 2
        if times[middle] <= at:
            k = middle
        else:
            last = middle
    length = times[last] - times[k]
    share = min(max((at - times[k]) / length, 0.0), 1.0) if length > 0.0 else 1.0
    for i in range(4):
        out[i] = poses[k, i] + share * (poses[last, i] - poses[k, i])


@brief_exact_kernel
def rows_at(tracks: Tracks, shapes: Floats, time: float) -> Floats:
    """Rows (B, ROW) of what is on tracks, at a time; `shapes` (B, ROW) are those about the world's origin, not turned.

    A shape's middle may be beside its origin; a track turns it about the origin, its own Y upright.
    """
    out, pose = shapes.copy(), np.empty(4)
    for b in range(shapes.shape[0]):
        begin, end = tracks.starts[b], tracks.starts[b + 1]
        pose_at(tracks.times[begin:end], tracks.poses[begin:end], tracks.repeats[b], time, pose)
        sine, cosine, middle = np.sin(pose[3]), np.cos(pose[3]), shapes[b, CENTER:TURN]
        out[b, 0] = pose[0] + cosine * middle[0] + sine * middle[2]
        out[b, 1] = pose[1] + middle[1]
        out[b, 2] = pose[2] - sine * middle[0] + cosine * middle[2]
        out[b, 3], out[b, 4], out[b, 5] = cosine, 0.0, -sine
        out[b, 6], out[b, 7], out[b, 8] = 0.0, 1.0, 0.0
        out[b, 9], out[b, 10], out[b, 11] = sine, 0.0, cosine
    return out
