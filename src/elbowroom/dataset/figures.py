"""What is counted over all frames of a dataset: how near, how fast, in which postures."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup
from elbowroom.dataset.histogram import Histogram

Floats = NDArray[np.float64]

_WAIST, _LEFT, _RIGHT, _HEAD = (
    group.at.start for group in (DofGroup.WAIST, DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM, DofGroup.HEAD)
)
_POSTURES = {  # columns of q that are counted together, range in degrees
    "waist bends": ((_WAIST,), -25.0, 80.0, (0.0, 40.0, 80.0)),
    "waist twists": ((_WAIST + 1,), -45.0, 45.0, (-45.0, 0.0, 45.0)),
    "arms swing forward": ((_LEFT, _RIGHT), -60.0, 175.0, (0.0, 90.0, 175.0)),
    "arms lift sideways": ((_LEFT + 1, _RIGHT + 1), -45.0, 175.0, (0.0, 90.0, 175.0)),
    "elbows bend": ((_LEFT + 3, _RIGHT + 3), 0.0, 150.0, (0.0, 75.0, 150.0)),
    "head turns": ((_HEAD + 1,), -60.0, 60.0, (-60.0, 0.0, 60.0)),
}


def _clearance() -> Histogram:
    return Histogram("nearest obstacle", "cm", 0.0, 60.0, (0.0, 20.0, 40.0, 60.0))


def _speed() -> Histogram:
    return Histogram("speed", "m/s", 0.0, 2.0, (0.0, 0.5, 1.0, 1.5, 2.0))


def _lowering() -> Histogram:
    return Histogram("hips lowered", "half leg lengths", 0.0, 0.7, (0.0, 0.35, 0.7))


def _postures() -> dict[str, Histogram]:
    return {name: Histogram(name, "degrees", low, high, ticks) for name, (_, low, high, ticks) in _POSTURES.items()}


@dataclass(eq=False)
class Figures:
    """Histograms over all frames that were added."""

    clearance: Histogram = field(default_factory=_clearance)
    speed: Histogram = field(default_factory=_speed)
    lowering: Histogram = field(default_factory=_lowering)
    postures: Mapping[str, Histogram] = field(default_factory=_postures)

    @property
    def all(self) -> tuple[Histogram, ...]:
        """In the order in which they are shown."""
        return self.clearance, self.speed, self.lowering, *self.postures.values()

    def add(self, q: Floats, root: Floats, clearance: Floats) -> None:
        """Count frames: q (F, DOF), root (F, 7), clearance (F,) in metres, infinite without obstacles."""
        self.clearance.add(100.0 * clearance)
        self.speed.add(np.hypot(root[:, 3], root[:, 4]))
        self.lowering.add(q[:, LOWERING])
        for name, (columns, *_) in _POSTURES.items():
            self.postures[name].add(np.rad2deg(q[:, list(columns)]).ravel())
