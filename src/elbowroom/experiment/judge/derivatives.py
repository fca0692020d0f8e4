"""How smoothly a shown motion moves: speed, acceleration and jerk by finite differences between its frames."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS
from elbowroom.experiment.judge.motion import ShownMotion

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Extent:
    """How large something gets."""

    max: float
    p99: float  # 99th percentile over the frames


@dataclass(frozen=True)
class Derivatives:
    """Derivatives of a group's motion, over its joints together, or of the root's place; in units per s, s^2, s^3."""

    speed: Extent
    acceleration: Extent
    jerk: Extent


def derivatives(motion: ShownMotion) -> dict[str, Derivatives]:
    """Figures for every local group and `heading` in radians, and for `root` in metres.

    The waist's lowering counts in its own unit, see `body.dof`.

    Nothing is taken over a jump. Frames at one and the same time count once.
    """
    tracks = {
        **{group.label: motion.q[:, group.at] for group in LOCAL_GROUPS},
        "heading": motion.roots[:, 2:3],
        "root": motion.roots[:, :2],
    }
    return {name: _figures(motion, values) for name, values in tracks.items()}


def _length(rates: Floats) -> Floats:
    length: Floats = np.linalg.norm(rates, axis=1)
    return length


def _figures(motion: ShownMotion, values: Floats) -> Derivatives:
    orders: list[list[Floats]] = [[], [], []]
    for run in motion.runs():
        times, track = _moving(motion.times[run], values[run])
        for order in orders:
            if len(times) < 2:
                break
            steps = np.diff(times)
            track = np.diff(track, axis=0) / steps[:, None]
            times = times[:-1] + 0.5 * steps
            order.append(_length(track))
    return Derivatives(*(_extent(np.concatenate([np.empty(0), *order])) for order in orders))


def _moving(times: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Without frames that stand at the time of the frame before them."""
    kept = np.append(True, np.diff(times) > 1e-9)
    return times[kept], values[kept]


def _extent(values: Floats) -> Extent:
    if len(values) == 0:
        return Extent(0.0, 0.0)
    return Extent(float(values.max()), float(np.percentile(values, 99)))
