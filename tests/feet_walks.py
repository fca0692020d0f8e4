"""Walks on footholds without a controller: roots that follow wanted velocities, and the feet under them."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.foot_state import SWING
from elbowroom.body.gait.footholds import UNKNOWN, beside, onward
from elbowroom.body.gait.living import Body, body_of, living
from elbowroom.body.gait.stride import phase_rate
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import CARRIAGE, FOOT, ROOT_STATE

Floats = NDArray[np.float64]
Velocities = tuple[float, float, float]

DT = 1 / 60
KEY = 9  # frames of a key interval: five are known ahead
GAIT = body_model(proportional_humanoid()).gait
BODY = body_of(GAIT)
FASTEST = np.array([2.0, 2.0, 14.0]) * DT  # changes of velocity in a frame
WANTED: dict[str, Callable[[float], Velocities]] = {
    "start and stop": lambda t: (1.1 if 0.3 < t < 2.2 else 0.0, 0.0, 0.0),
    "turn in place": lambda t: (0.0, 0.0, 1.5 if t < 2.0 else 0.0),
    "strafe": lambda t: (0.0, 0.6 if t < 2.0 else 0.0, 0.0),
    "back": lambda t: (-0.7 if t < 2.0 else 0.0, 0.0, 0.0),
    "a bend": lambda t: (1.0 if t < 2.5 else 0.0, 0.0, 1.2 if 1.0 < t < 2.0 else 0.0),
    "creeping": lambda t: (0.3 if t < 2.5 else 0.0, 0.0, 0.0),
    "run": lambda t: (2.2 if t < 2.5 else 0.0, 0.0, 0.0),
}


def path(wanted: Callable[[float], Velocities], frames: int = 300, phase: float = 0.0) -> Floats:
    """Root states (frames, 7) that follow wanted velocities as fast as accelerations allow."""
    roots, velocity = np.zeros((frames, ROOT_STATE)), np.zeros(3)
    roots[0, 6] = phase
    for k in range(1, frames):
        velocity = velocity + np.clip(np.array(wanted(k * DT)) - velocity, -FASTEST, FASTEST)
        s, c = np.sin(roots[k - 1, 2]), np.cos(roots[k - 1, 2])
        forward, lateral, turn = velocity
        moved = [forward * s + lateral * c, forward * c - lateral * s, turn]
        roots[k, :3], roots[k, 3:6] = roots[k - 1, :3] + DT * np.array(moved), velocity
        roots[k, 6] = roots[k - 1, 6] + DT * phase_rate(forward, lateral, turn)
    return roots


def walked(roots: Floats) -> Floats:
    """The same with feet, (frames, WITH_FEET)."""
    rows = [beside(GAIT, roots[0])]
    for k, root in enumerate(roots[1:], 1):
        coming = roots[k + KEY :: KEY][:5]
        times = KEY * DT * np.arange(1.0, len(coming) + 1.0)
        rows.append(onward(GAIT, rows[-1], root, DT, np.column_stack([times, coming])))
    return np.array(rows)


def in_world(rows: Floats, side: int) -> Floats:
    """Where a flat foot is in the world (N, 3): x, z, yaw."""
    x, z, yaw = rows[:, ROOT_STATE + FOOT * side :].T[:3]
    s, c = np.sin(rows[:, 2]), np.cos(rows[:, 2])
    return np.stack([rows[:, 0] + x * c + z * s, rows[:, 1] - x * s + z * c, rows[:, 2] + yaw], axis=1)


def random_wish(seed: int) -> Callable[[float], Velocities]:
    rng = np.random.default_rng(seed)
    wishes = rng.uniform([-0.7, -0.6, -2.0], [2.0, 0.6, 2.0], (8, 3)) * rng.integers(0, 2, (8, 3))
    return lambda t: tuple(wishes[int(t / 0.5)]) if t < 4.0 else (0.0, 0.0, 0.0)


def random_feet(rng: np.random.Generator, roots: Floats) -> Floats:
    """Root states (N, 7) with feet anywhere near (N, WITH_FEET): flat or pitched, on the ground or in their swing."""
    low, high = np.zeros(FOOT), np.zeros(FOOT)
    low[:SWING], high[: SWING + 1] = [-0.1, -0.45, -0.6, -0.4, 0.0], [0.1, 0.45, 0.6, 1.1, 0.06, 0.99]
    feet = [rng.uniform(low, high, (len(roots), FOOT)) + np.eye(FOOT)[0] * aside for aside in (0.09, -0.09)]
    return np.hstack([roots, np.zeros((len(roots), ROOT_STATE - roots.shape[1])), *feet])


def random_carriage(rng: np.random.Generator, rows: Floats) -> Floats:
    """The same rows (N, WITH_FEET), hips, chest and head carried anyhow (N, SHOWN)."""
    most = np.array([0.03, 0.02, 0.02, 0.15, 0.1, 0.15, 0.05, 0.05, 0.7, 0.2, 0.0, 0.0, 0.0])
    return np.hstack([rows, rng.uniform(-most, most, (len(rows), CARRIAGE))])


def alive(rows: Floats, room: Callable[[int], float] = lambda _: np.inf, body: Body = BODY) -> Floats:
    """Rows (frames, WITH_FEET) as they live (frames, SHOWN), with so much room in each frame, metres."""
    shown = [np.concatenate([rows[0], np.zeros(CARRIAGE)])]
    for k, row in enumerate(rows[1:], 1):
        shown.append(living(body, shown[-1], row, DT, room(k), UNKNOWN))
    return np.array(shown)
