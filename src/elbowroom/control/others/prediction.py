"""What others are told about an avatar's way: boxes round the parts of its body, and its body for a moment.

As far as key frames are known the boxes go with them, and then straight on for a while. Steps aside are not taken to go
on: who walks ahead and makes way to the side will soon be beside.
"""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.key_frame_queue import KeyFrameQueue, KeyFrames, Playback
from elbowroom.control.others.neighbour import Neighbour, Walker
from elbowroom.control.shown.body_check import configuration
from elbowroom.world.obstacles.shapes import Box, extents_of
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track

Floats = NDArray[np.float64]

# How a pose of the queue is shown some seconds after another, `ahead` (m, 8) of which key frames are still to come.
Follow = Callable[[Playback, Playback, float, Floats], Playback]

_BEYOND = 2.0  # seconds after the last key frame
_SPARE = 0.02  # metres: between key frames limbs may reach a little farther
_THIN = 0.02  # metres: no box becomes thinner
_MOMENTS = np.arange(10) / 60  # seconds from now: a key interval


def neighbour(
    humanoid: Humanoid,
    model: BodyModel,
    walker: Walker,
    shown: Playback,
    queue: KeyFrameQueue,
    follow: Follow,
    *,
    onward: bool,
) -> Neighbour:
    """What others are told about an avatar that is shown now, and will show what is in the queue; as `predicted`."""
    coming = queue.unplayed()
    keys = KeyFrames(
        np.append(queue.time, coming.times),
        np.vstack([shown.root[:ROOT_STATE], coming.roots]),
        np.vstack([shown.upper, coming.uppers]),
    )
    times = queue.time + (_MOMENTS if len(coming.times) else _MOMENTS[:1])
    played = [shown]
    for before, time in pairwise(times.tolist()):
        later, still = queue.at(min(time, float(coming.times[-1]))), coming.times > time
        ahead = np.column_stack([coming.times[still] - time, coming.roots[still]])
        played.append(follow(played[-1], later, time - before, ahead))
    soon = KeyFrames(times, np.array([one.root for one in played]), np.array([one.upper for one in played]))
    axes = posture_capsules(model, _postures(soon), soon.roots).transpose(2, 0, 1).astype(np.float64)
    return Neighbour(walker, predicted(humanoid, model, keys, onward=onward), times, axes, humanoid.capsules.radii)


def predicted(humanoid: Humanoid, model: BodyModel, keys: KeyFrames, *, onward: bool) -> Moving:
    """Moving boxes that hold the avatar at its key frames; the first of these is shown now.

    `onward`: whether it wants to go ahead. Then a step back gives way, and does not go on.
    """
    segments = posture_capsules(model, _postures(keys), keys.roots).astype(np.float64)
    radii = humanoid.capsules.radii[:, None, None]
    ends = segments.reshape(len(radii), 2, 3, -1)
    dx, dz = ends[:, :, 0] - keys.roots[:, 0], ends[:, :, 2] - keys.roots[:, 1]
    sine, cosine = np.sin(keys.roots[:, 2]), np.cos(keys.roots[:, 2])
    own = np.stack([dx * cosine - dz * sine, ends[:, :, 1], dx * sine + dz * cosine], axis=2)
    times, places, yaws = _way(keys, onward)
    sine, cosine = np.sin(yaws), np.cos(yaws)
    tracks = []
    for group in DofGroup:
        part = humanoid.capsules.of(group)
        low = (own[part] - radii[part, None]).min(axis=(0, 1, 3)) - _SPARE
        high = (own[part] + radii[part, None]).max(axis=(0, 1, 3)) + _SPARE
        left, middle, ahead = 0.5 * (low + high)
        x = places[:, 0] + left * cosine + ahead * sine
        z = places[:, 1] - left * sine + ahead * cosine
        centers = np.stack([x, np.full(len(times), middle), z], axis=1)
        tracks.append(Track(f"{humanoid.name}: {group.label}", _box(high - low), times, centers, yaws, Repeat.ONCE))
    return Moving(tuple(tracks))


def slimmer(moving: Moving, margin: float) -> Moving:
    """The same boxes, `margin` metres less to every side: so that who is in touch with one can leave it."""
    less = np.array([2.0 * margin, 0.0, 2.0 * margin])
    sizes = [np.maximum(2.0 * extents_of(track.shape) - less, _THIN) for track in moving.tracks]
    rows = zip(moving.tracks, sizes, strict=True)
    return Moving(tuple(replace(track, shape=_box(size)) for track, size in rows))


def _box(size: Floats) -> Box:
    x, y, z = size.tolist()
    return Box((x, y, z))


def _postures(keys: KeyFrames) -> Floats:
    return np.array([configuration(root, upper) for root, upper in zip(keys.roots, keys.uppers, strict=True)])


def _way(keys: KeyFrames, onward: bool) -> tuple[Floats, Floats, Floats]:
    """Times (K,), places (K, 2) and headings (K,): those of the key frames, and one more straight on."""
    last = keys.roots[-1]
    ahead, aside = last[3], last[4]
    if abs(ahead) > abs(aside):
        aside = 0.0
    if onward:
        ahead = max(ahead, 0.0)
    sine, cosine = np.sin(last[2]), np.cos(last[2])
    velocity = np.array([ahead * sine + aside * cosine, ahead * cosine - aside * sine])
    times = np.append(keys.times, keys.times[-1] + _BEYOND)
    places = np.vstack([keys.roots[:, :2], last[:2] + _BEYOND * velocity])
    return times, places, np.append(keys.roots[:, 2], last[2])
