"""What obstacles on tracks sweep in spans of time, as boxes that hold it: one compiled call for all of both."""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.world.obstacles.layout import ROW, ShapeKind
from elbowroom.world.obstacles.tracks.poses import LOOP, ONCE, PINGPONG, Tracks, pose_at

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_BOX = float(ShapeKind.BOX)
_PARTS = 4  # of a span of time in which a sweep is sampled


@inner_exact_kernel
def _turning_points(times: Floats, repeat: int, first: float, last: float, out: Floats) -> int:
    """How often a track is at a key pose between two times; into `out` (N,) when, in order."""
    span, count = times[-1], 0
    still = span == 0.0 or repeat == ONCE
    period = np.inf if still else span if repeat == LOOP else 2.0 * span
    begin, end = (0, 1) if still else (math.floor(first / period), math.floor(last / period) + 1)
    for lap in range(begin, end):
        base = 0.0 if still else period * lap
        for back in range(2 if repeat == PINGPONG and not still else 1):
            for i in range(times.shape[0]):
                at = base + (period - times[times.shape[0] - 1 - i] if back else times[i])
                if first < at < last:
                    if count < out.shape[0]:
                        out[count] = at
                    count += 1
    return count


@helper
def _samples(times: Floats, repeat: int, first: float, last: float) -> Floats:
    """The times at which a track is sampled in a span, in order: evenly, and at its key poses."""
    count = _PARTS + 1 + _turning_points(times, repeat, first, last, np.empty(0))
    samples = np.empty(count)
    for i in range(_PARTS + 1):
        samples[i] = first + i / _PARTS * (last - first)
    _turning_points(times, repeat, first, last, samples[_PARTS + 1 :])
    for i in range(_PARTS + 1, count):  # each goes down among the few even ones
        time, place = samples[i], i
        while samples[place - 1] > time:
            samples[place] = samples[place - 1]
            place -= 1
        samples[place] = time
    return samples


@helper
def _sweep(times: Floats, poses: Floats, half: Floats, repeat: int, first: float, last: float, out: Floats) -> None:
    """The row of a box, turned as the track is in the middle of a span, round its corners at all its times."""
    samples, pose = _samples(times, repeat, first, last), np.empty(4)
    pose_at(times, poses, repeat, 0.5 * (first + last), pose)
    yaw, reach = pose[3], math.hypot(half[0], half[2])
    sine, cosine, farthest, before = np.sin(yaw), np.cos(yaw), 0.0, 0.0
    low, high = np.empty(3), np.empty(3)
    low[:], high[:] = np.inf, -np.inf
    for i in range(samples.shape[0]):
        pose_at(times, poses, repeat, samples[i], pose)
        turned = pose[3] - yaw
        farthest = max(farthest, abs(turned - before)) if i > 0 else 0.0
        before = turned
        c, s = abs(np.cos(turned)), abs(np.sin(turned))
        wide, deep = half[0] * c + half[2] * s, half[0] * s + half[2] * c
        across, along = pose[0] * cosine - pose[2] * sine, pose[0] * sine + pose[2] * cosine
        low[0], high[0] = min(low[0], across - wide), max(high[0], across + wide)
        low[1], high[1] = min(low[1], pose[1] - half[1]), max(high[1], pose[1] + half[1])
        low[2], high[2] = min(low[2], along - deep), max(high[2], along + deep)
    bulge = 0.125 * reach * farthest * farthest  # of an arc beyond its chord
    across, along = 0.5 * (low[0] + high[0]), 0.5 * (low[2] + high[2])
    out[0], out[1], out[2] = across * cosine + along * sine, 0.5 * (low[1] + high[1]), along * cosine - across * sine
    out[3], out[4], out[5] = cosine, 0.0, -sine
    out[6], out[7], out[8] = 0.0, 1.0, 0.0
    out[9], out[10], out[11] = sine, 0.0, cosine
    for i in range(3):
        out[12 + i] = 0.5 * (high[i] - low[i]) + (0.0 if i == 1 else bulge)
    out[15], out[16], out[17] = 0.0, _BOX, 0.0


@exact_kernel
def swept_rows(tracks: Tracks, first: Floats, last: Floats) -> Floats:
    """Rows (n, B, ROW) of boxes that hold what each sweeps in each span of time, from `first` (n,) to `last`."""
    out = np.empty((first.shape[0], tracks.halves.shape[0], ROW))
    for b in range(tracks.halves.shape[0]):
        begin, end = tracks.starts[b], tracks.starts[b + 1]
        times, poses, half = tracks.times[begin:end], tracks.poses[begin:end], tracks.halves[b]
        for n in range(first.shape[0]):
            _sweep(times, poses, half, tracks.repeats[b], first[n], last[n], out[n, b])
    return out
