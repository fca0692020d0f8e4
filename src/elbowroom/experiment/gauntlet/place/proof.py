"""The proof that a course in a place can be crossed: somebody of this body who walks the way upright, arms at rest.

It goes straight from corner to corner and turns on the spot, in any phase of its stride. Whatever keeps a margin from
all of its poses leaves that walk possible; who walks is free to find a better one.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import followed
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.experiment.gauntlet.body_rows import BodyRows, rows_of
from elbowroom.experiment.gauntlet.speeds import WALK_SPEED
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.obstacles import Obstacles

Floats = NDArray[np.float64]

_SPACING = 0.04  # metres from pose to pose
_TURNS = math.radians(8.0)  # from pose to pose on the spot
_BETWEEN = 0.03  # metres by which capsules are thicker: what a pose differs from those between which it lies
_PHASES = np.arange(8) / 8.0
_AT_ONCE = 32  # poses that are held against what stands


class ProvenWalk(NamedTuple):
    """The poses of a walk along a way."""

    rows: BodyRows  # of all capsules, with the way that lies behind them
    segments: NDArray[np.float32]  # (C, 6, N) the same capsules
    radii: Floats  # (C,) metres
    way: Floats  # (N,) metres
    length: float  # metres


def proven_walk(humanoid: Humanoid, corners: Floats) -> ProvenWalk:
    """Walk along `corners` (m, 2), x and z."""
    model, (places, headings, way) = body_model(humanoid), _along(corners)
    count = len(places)
    states = np.zeros((count * len(_PHASES), 7))
    states[:, :2], states[:, 2] = np.repeat(places, len(_PHASES), axis=0), np.repeat(headings, len(_PHASES))
    states[:, 3], states[:, 6] = WALK_SPEED, np.tile(_PHASES, count)
    uppers = followed(natural_walk()(RootPath(0.0, 1.0, states)))
    q = np.concatenate([states[:, :3], uppers], axis=1)
    segments, radii = posture_capsules(model, q, states), humanoid.capsules.radii + _BETWEEN
    ways = np.repeat(way, len(_PHASES))
    return ProvenWalk(rows_of(segments, radii, ways), segments, radii, ways, float(way[-1]))


def keeps_clear(walk: ProvenWalk, obstacles: Obstacles, margin: float) -> bool:
    """Whether all poses keep a margin from all that stands."""
    for first in range(0, walk.segments.shape[2], _AT_ONCE):
        some = walk.segments[:, :, first : first + _AT_ONCE].astype(np.float64)
        x, z = float(some[0, 0, 0]), float(some[0, 2, 0])
        some[:, [0, 3]] -= x
        some[:, [2, 5]] -= z
        if obstacles.clearance(some.astype(np.float32), walk.radii, (x, z), 0.0) < margin:
            return False
    return True


def _along(corners: Floats) -> tuple[Floats, Floats, Floats]:
    """Places (N, 2), headings (N,) and way (N,) of poses from corner to corner, turning on the spot."""
    steps = np.diff(corners, axis=0)
    lengths, turned = np.hypot(*steps.T), np.unwrap(np.arctan2(steps[:, 0], steps[:, 1]))
    places, headings, way, behind = list[Floats](), list[Floats](), list[Floats](), 0.0
    for k, (length, heading) in enumerate(zip(lengths, turned, strict=True)):
        along = np.linspace(0.0, length, max(2, math.ceil(length / _SPACING) + 1))
        before = turned[k - 1] if k else heading
        spins = np.linspace(before, heading, math.ceil(abs(heading - before) / _TURNS) + 1)[:-1]
        places += [np.tile(corners[k], (len(spins), 1)), corners[k] + np.outer(along / length, steps[k])]
        headings += [spins, np.full(len(along), heading)]
        way += [np.full(len(spins), behind), behind + along]
        behind += float(length)
    return np.concatenate(places), np.concatenate(headings), np.concatenate(way)
