"""Poses, obstacles and recordings for the judge's tests."""

import json
import struct
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, LOCAL_GROUPS, limits
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.control.recordings.recording import ASSIST, MAGIC, STEP
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Gate, Scene

Floats = NDArray[np.float64]

T_POSE = np.zeros(DOF)
T_POSE[[7, 11]] = 0.5 * np.pi


def random_postures(rng: np.random.Generator, count: int) -> tuple[Floats, Floats]:
    """Configurations (N, 14) within their limits, root states (N, 7) near the origin."""
    low, high = np.concatenate([limits(group) for group in LOCAL_GROUPS]).T
    roots = rng.uniform([-1.0, -1.0, -4.0, -0.8, -0.4, -1.0, -3.0], [1.0, 1.0, 4.0, 1.6, 0.4, 1.0, 3.0], (count, 7))
    return np.concatenate([roots[:, :3], rng.uniform(low, high, (count, LOCAL))], axis=1), roots


def scene_with(boxes: Obstacles) -> Scene:
    names = tuple(f"box {i}" for i in range(len(boxes)))
    return Scene(
        "made",
        "Made",
        "",
        (0.0, 0.0),
        (20.0, 20.0),
        RootState(),
        Gate((0.0, 5.0)),
        replace(boxes, standing_names=names),
    )


def upright(*rows: tuple[tuple[float, float, float], tuple[float, float, float]]) -> Obstacles:
    """Boxes along the axes: centre and size of each."""
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (len(rows), 1))
    return Obstacles.boxes(np.array([c for c, _ in rows]), turns, 0.5 * np.array([s for _, s in rows]))


def random_boxes(rng: np.random.Generator, count: int) -> Obstacles:
    turns = rng.normal(size=(count, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    centers = rng.uniform([-1.2, 0.0, -1.2], [1.2, 1.8, 1.2], (count, 3))
    return Obstacles.boxes(centers, turns, rng.uniform(0.02, 0.25, (count, 3)))


def gliding(posture: Floats, frames: int, speed: float, z: float = 0.0) -> tuple[Floats, Floats]:
    """A frozen posture that is pushed along +Z at 60 frames a second: configurations and root states."""
    roots = np.zeros((frames, ROOT_STATE))
    roots[:, 1] = z + speed * np.arange(frames) / 60.0
    q = np.tile(posture, (frames, 1))
    q[:, :3] = roots[:, :3]
    return q, roots


def write_recording(
    path: Path, header: dict[str, Any], q: Floats, roots: Floats, flags: NDArray[np.int_] | int = ASSIST
) -> None:
    """A recording by hand, one chunk for each 60 frames."""
    steps = np.zeros(len(q), STEP)
    steps["q"], steps["dt"], steps["flags"], steps["direction"] = q, 1 / 60, flags, np.nan
    steps["root"][:, : roots.shape[1]] = roots
    text = json.dumps(header).encode()
    crc, data = 0, MAGIC + struct.pack("<I", len(text)) + text + struct.pack("<I", zlib.crc32(text))
    for first in range(0, len(steps), 60):
        chunk = zlib.compress(steps[first : first + 60].tobytes())
        count = len(steps[first : first + 60])
        data += struct.pack("<4sIII", b"CHNK", count, len(chunk), zlib.crc32(chunk)) + chunk
        crc = zlib.crc32(chunk, crc)
    data += struct.pack("<4sIII", b"DONE", len(steps), 0, crc)
    path.write_bytes(data)
