"""A run packed small, for a page that plays it without a server.

What is packed: the length of the head (uint32), the head as JSON, scalars of all frames (float32, one column after the
other), rotations of the avatar's nodes and, where there is no mesh, its capsules' ends about the root (int16, column by
column, each value as the difference to the one before, modulo 2^16), and the avatar's GLB. Little-endian.
"""

import json
import struct
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.server.wire import pose_frame
from elbowroom.server.wire.pose_frame import PoseFrame, parse

SCALARS = (
    "sim_time", "flags", "epoch", "phase", "x", "y", "z", "heading", "forward", "lateral", "turn", "gait", "clearance",
    "hips_x", "hips_y", "hips_z",
)  # fmt: skip
UNIT = 32767.0  # a rotation's component of 1
PER_METRE = 4000.0  # of a capsule's end: a quarter of a millimetre; 8 metres to each side at most
MOST_FRAMES = 3000  # a longer run is told by every second frame, or every third ...
MOST_HEAD = 4 * 2**20  # bytes: a scene of ten thousand boxes has fewer
RATE = 30.0  # frames a second, at most
Floats32 = NDArray[np.float32]

_LENGTH = struct.Struct("<I")


class PackedRun(NamedTuple):
    """What is to be played."""

    head: dict[str, Any]  # `name`, `planner`, `note`, and `scene` and `avatar` as a client is told of them
    frames: bytes  # pose frames of one size
    glb: bytes | None  # the avatar's file; None: its capsules are shown


def read_run(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Head and frames of a run as it travels (`schema.runs`); raises `InputError`."""
    if MOST_HEAD < int.from_bytes(data[: _LENGTH.size], "little") <= len(data):
        raise InputError(f"run: its head is longer than {MOST_HEAD} bytes")
    try:
        (length,) = _LENGTH.unpack_from(data)
        head = json.loads(data[_LENGTH.size : _LENGTH.size + length])
        frames = data[_LENGTH.size + length :]
        whole = isinstance(head["scene"], dict) and isinstance(head["avatar"], dict) and isinstance(head["name"], str)
    except (struct.error, ValueError, KeyError, TypeError, RecursionError):
        whole = False
    if not whole:
        raise InputError("run: what was sent is no run")
    return head, frames


def pack_run(run: PackedRun) -> bytes:
    """Pack it; raises `InputError` where the frames are damaged."""
    frames = _few(_parsed(run.frames))
    roots = np.array([[f.x, f.y, f.z] for f in frames], np.float32)
    scalars = np.array([[getattr(f, name) for name in SCALARS] for f in frames], np.float32).T
    times = np.array([f.time for f in frames], np.float64)
    rotations, capsules = _rotations(run, frames), _capsules(run, frames, roots)
    if not (np.isfinite(rotations).all() and np.isfinite(capsules).all() and np.isfinite(times).all()):
        raise InputError("run: its numbers are out of range")
    head = {
        **run.head,
        "frames": len(frames),
        "joints": rotations.shape[1],
        "capsules": capsules.shape[1],
        "scalars": list(SCALARS),
        "avatarBytes": len(run.glb or b""),
    }
    told = json.dumps(head, separators=(",", ":"), ensure_ascii=False).encode()
    parts = [
        (times - times[0]).astype("<f4").tobytes(), scalars.astype("<f4").tobytes(),
        _columns(rotations, UNIT), _columns(capsules, PER_METRE), run.glb or b"",
    ]  # fmt: skip
    return b"".join([_LENGTH.pack(len(told)), told, *parts])


def _columns(values: NDArray[np.float32], unit: float) -> bytes:
    """Values (N, ...) as differences of int16, column by column."""
    table = np.clip(np.rint(values.reshape(len(values), -1).astype(np.float64) * unit), -UNIT, UNIT).astype(np.int64).T
    steps = np.diff(table, axis=1, prepend=0)
    return ((steps + 2**15) % 2**16 - 2**15).astype("<i2").tobytes()


def _rotations(run: PackedRun, frames: list[PoseFrame]) -> Floats32:
    """(N, J, 4)"""
    bones = len(run.head["avatar"].get("bones", ()))
    if any(len(frame.rotations) != bones for frame in frames):
        raise InputError("run: its frames are not of this avatar")
    return np.array([frame.rotations for frame in frames])


def _capsules(run: PackedRun, frames: list[PoseFrame], roots: Floats32) -> Floats32:
    """(N, C, 6) about the root; none where there is a mesh."""
    if run.glb is not None:
        return np.empty((len(frames), 0, 6), np.float32)
    many = len(run.head["avatar"].get("capsules", ()))
    if any(len(frame.capsules) != many for frame in frames):
        raise InputError("run: the avatar's file cannot be put in, and the frames were kept without its capsules")
    about: Floats32 = np.array([frame.capsules for frame in frames]) - np.tile(roots, 2)[:, None]
    return about


def _parsed(data: bytes) -> list[PoseFrame]:
    """One frame after the other; raises `InputError`."""
    frames, at, counts = [], 0, pose_frame.offsets()["joint_count"]
    try:
        while at < len(data):
            joints, capsules = struct.unpack_from("<HH", data, at + counts)
            size = pose_frame.HEAD_SIZE + 16 * joints + 24 * capsules
            frames.append(parse(data[at : at + size]))
            at += size
    except (struct.error, ValueError):
        frames = []
    if not frames:
        raise InputError("run: its frames are damaged")
    return frames


def _few(frames: list[PoseFrame]) -> list[PoseFrame]:
    """No more than so many frames a second, in order of time; at a jump both sides are kept."""
    seconds = max(frames[-1].time - frames[0].time, 1e-3)
    gap = max(1.0 / RATE, seconds / MOST_FRAMES) - 1e-4
    kept = [frames[0]]
    for before, frame in pairwise(frames):
        if frame.epoch != kept[-1].epoch and before.time > kept[-1].time:
            kept.append(before)
        if frame.time - kept[-1].time >= gap or (frame.epoch != before.epoch and frame.time > kept[-1].time):
            kept.append(frame)
    if frames[-1].time > kept[-1].time:
        kept.append(frames[-1])
    return kept
