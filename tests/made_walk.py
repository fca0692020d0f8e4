"""Our own gait along a straight line, as if it had been captured."""

from dataclasses import replace

import numpy as np

from bvh_builder import BONES
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, hips_position, local_rotations
from elbowroom.body.root import RootState
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.geometry import quaternion

HUMANOID = proportional_humanoid(1.7)
FPS, PACE, SPEED = 60.0, 0.9, 1.1  # frames a second, strides a second, m/s


def upper_at(phases: np.ndarray) -> np.ndarray:
    """A made-up upper body (n, 13) in time with the stride."""
    angle = 2.0 * np.pi * phases
    waves = [0.1 + 0.05 * np.cos(angle), 0.1 * np.sin(angle), 0.0 * angle]
    for shift in (0.0, np.pi):
        waves += [
            0.4 * np.sin(angle + shift),
            0.2 + 0.05 * np.cos(angle),
            0.1 * np.cos(angle),
            0.5 + 0.2 * np.sin(angle),
        ]
    waves += [0.1 + 0.1 * np.sin(angle), 0.2 * np.cos(angle)]
    return np.stack(waves, axis=1)


def made_walk(strides: float = 3.0, first_phase: float = 0.3, *, on_the_spot: bool = False) -> BodyMotion:
    """Our own gait along a straight line, as if it had been captured."""
    times = np.arange(round(strides / PACE * FPS) + 1) / FPS
    phases = first_phase + PACE * times
    states = [RootState(0.5, SPEED * t, 0.0, SPEED, 0.0, 0.0, p).as_array() for t, p in zip(times, phases, strict=True)]
    motion = captured(HUMANOID, np.array(states), upper_at(phases))
    return replace(motion, hips=motion.hips - np.outer(SPEED * times, [0.0, 0.0, 1.0])) if on_the_spot else motion


def captured(humanoid: Humanoid, rows: np.ndarray, uppers: np.ndarray) -> BodyMotion:
    """Root states (F, 7), or with feet and carriage (F, SHOWN), and upper bodies (F, LOCAL), as if captured."""
    model, skeleton = body_model(humanoid), humanoid.skeleton
    index = [skeleton.index(bone) for bone in BONES]
    turns, hips = [], []
    for row, upper in zip(rows, uppers, strict=True):
        q = np.concatenate([row[:3], upper])
        local = local_rotations(model, q, row)
        for joint in range(1, len(local)):
            local[joint] = quaternion.multiply(local[skeleton.parents[joint]], local[joint])
        heading = quaternion.about_axis(1, row[2])
        turns.append(quaternion.multiply(heading, local[index]))
        hips.append(quaternion.rotate(heading, hips_position(model, q, row)) + np.array([row[0], 0.0, row[1]]))
    soles = np.array([[[x, 0.0, -0.06], [x, 0.0, 0.15]] for x in (0.1, -0.1)])
    return BodyMotion("made", BONES, skeleton.positions[index], 1.0 / FPS, np.array(turns), np.array(hips), soles)
