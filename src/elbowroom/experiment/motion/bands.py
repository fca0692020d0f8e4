"""What a person's figures are, and which of a report lie outside; where each number comes from: docs/motion.md."""

import math
from dataclasses import dataclass

import numpy as np

STANCE_SHARES = ((0.5, 62.5), (0.8, 61.5), (1.1, 60.4), (1.4, 59.3), (2.0, 57.2))  # m/s, % of a stride: Kirtley 1985
SHARE_WITHIN = 2.0  # %
WRIST_SPARC = (-3.0, -2.4)  # of recorded wrists, where a window does not happen to hold whole strides
KNEE_SPEED, KNEE_ACCELERATION = 700.0, 25_000.0  # deg/s, deg/s²: recorded ones have nearly as much
BORNE_DOWN, BORNE_UP = 80.0, 60.0  # % of a sole from heel to ball with ground under it, of who goes down or up
_STRIDES = (0.9, 0.95, 1.0, 1.05, 1.1)  # seconds
_ROUGHEST = (-3.07, -3.08, -3.25, -3.06, -2.92)  # SPARC of the wrists of two recorded walks at these


@dataclass(frozen=True)
class Band:
    """A figure and where it should lie; one end may be open."""

    name: str
    value: float | None  # None where it could not be measured
    low: float
    high: float
    unit: str

    @property
    def inside(self) -> bool:
        """Whether it lies there."""
        return self.value is not None and self.low <= self.value <= self.high

    @property
    def wanted(self) -> str:
        """The band in words."""
        if math.isinf(self.low):
            return f"at most {self.high:g} {self.unit}".rstrip()
        if math.isinf(self.high):
            return f"at least {self.low:g} {self.unit}".rstrip()
        return f"{self.low:g} to {self.high:g} {self.unit}".rstrip()


def at_most(name: str, value: float | None, high: float, unit: str) -> Band:
    """A figure that is better small."""
    return Band(name, value, -math.inf, high, unit)


def at_least(name: str, value: float | None, low: float, unit: str) -> Band:
    """A figure that is better large."""
    return Band(name, value, low, math.inf, unit)


def stance_share(speed: float) -> float:
    """The part of a stride that a foot stands at a speed in m/s, %, between the published ones by proportion."""
    (slow, share), *others = STANCE_SHARES
    for fast, next_share in others:
        if speed <= fast or (fast, next_share) == STANCE_SHARES[-1]:
            return share + (next_share - share) * (speed - slow) / (fast - slow)
        slow, share = fast, next_share
    raise AssertionError


def wrist_sparc(stride: float) -> tuple[float, float]:
    """Where the SPARC of a swinging wrist should lie at a stride in seconds.

    The measure is of windows of 2 s, which two strides of about a second fill: there recorded wrists have less too.
    """
    low, high = WRIST_SPARC
    return min(low, float(np.interp(stride, _STRIDES, _ROUGHEST))), high
