"""Recordings of a random motion that nobody planned: every joint moves, steps of time vary, and it is put back once."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame, Phase
from elbowroom.control.key_frame_queue import KeyFrames
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_NO_KEYS = KeyFrames(np.empty(0), np.empty((0, ROOT_STATE)), np.empty((0, LOCAL)))


class Made(NamedTuple):
    """A recording and what is in it."""

    recording: Recording
    q: Floats  # (F, DOF)
    roots: Floats  # (F, ROOT_STATE)
    times: Floats  # (F,)
    restart: int  # the frame before which it was put back


def made_recording(path: Path, humanoid: Humanoid, frames: int = 60, *, even: bool = True, seed: int = 0) -> Made:
    """Write and open a recording; `even`: 60 frames a second and no restart."""
    rng = np.random.default_rng(seed)
    t = np.arange(frames)[:, None] / 60.0
    q = 0.5 + 0.4 * np.sin(2.0 * np.pi * t * rng.uniform(0.2, 0.8, DOF) + rng.uniform(0.0, 6.0, DOF))
    roots = np.concatenate(
        [1.2 * t, 0.4 * np.sin(t), 2.0 + 3.0 * t, np.full_like(t, 1.2), 0.0 * t, 0.0 * t, 0.9 * t], axis=1
    )
    roots = np.hstack([roots, np.zeros((frames, ROOT_STATE - roots.shape[1]))])
    q[:, :3] = roots[:, :3]
    dt = np.full(frames, 1.0 / 60.0) if even else rng.uniform(0.0, 0.05, frames)
    restart = frames if even else frames // 2
    times = np.cumsum(dt)
    with Recorder(path, Controller(humanoid, Scene.load("empty"))) as recorder:
        for i in range(frames):
            time = times[i] - (times[restart] if i >= restart else 0.0)
            told = Phase.PLAY, np.inf, False, False, 0, _NO_KEYS, None, Command(forward=1.0)
            recorder.append(Frame(time, q[i], roots[i], *told), dt[i])
    return Made(Recording(path), q, roots, times, restart)
