"""How much of a standing foot has ground under it: a foot on a tread, or on its heel over the edge of one.

A foot rolls while it stands, so not all of its sole is on the ground at once. Each place of the sole counts that is at
some moment of a stance as near the ground as it is where the foot stands flat, and 1 cm more: a place over an edge
never is. Who goes up a stair sets down the front of the foot, who goes down nearly all of it, so these are told apart.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.motion.stance import stretches

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

NEAR = 0.01  # metres of air under a place of a sole that is borne
_CLIMBS = 0.02  # metres that a body goes up or down in a stance, or it stays level


@dataclass(frozen=True)
class Under:
    """Of the soles' length from heel to ball, that with ground under it, in some stances, %."""

    stances: int
    mean: float | None  # None without a stance
    least: float | None


@dataclass(frozen=True)
class Borne:
    """The same of stances in which the body stays level, goes up and goes down."""

    level: Under
    up: Under
    down: Under


def shares(heights: Floats, standing: Bools, flat: Floats, body: Floats) -> Floats:
    """How far the body goes up in each whole stance of a foot, metres, and how much of the foot's length is borne.

    `heights` (N, P) of places of its sole above the ground, metres; `standing` (N,); `flat` (P, 2) as in `sole.Sole`;
    `body` (N,) how high the body's place is. What is before the joint of the toes does not count: toes may be over an
    edge. Returns (stances, 2).
    """
    order = np.argsort(flat[:, 0], kind="stable")
    near, ahead = heights[:, order] < flat[order, 1] + NEAR, flat[order, 0]
    ends = np.concatenate([ahead[:1], 0.5 * (ahead[1:] + ahead[:-1]), ahead[-1:]])
    lengths = np.diff(np.minimum(ends, 0.0))  # that each place stands for, up to the toes
    length = max(float(lengths.sum()), 1e-9)
    runs = [run for run in stretches(standing) if run.start > 0 and run.stop < len(standing)]
    found = [(body[run.stop] - body[run.start], lengths[near[run].any(axis=0)].sum() / length) for run in runs]
    return np.array(found).reshape(-1, 2)


def borne(found: Iterable[Floats]) -> Borne:
    """The figures of some feet together, of what `shares` found of each."""
    climbs, parts = np.concatenate([*found, np.empty((0, 2))]).T
    up, down = climbs > _CLIMBS, climbs < -_CLIMBS
    return Borne(_under(parts[~up & ~down]), _under(parts[up]), _under(parts[down]))


def _under(parts: Floats) -> Under:
    if not len(parts):
        return Under(0, None, None)
    return Under(len(parts), 100.0 * float(np.mean(parts)), 100.0 * float(parts.min()))
