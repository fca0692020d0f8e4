"""The mean stride of the leg's joints, and how it lies beside the published ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.motion.angles import JOINTS, leg_angles
from elbowroom.experiment.motion.cycles import PARTS, in_strides
from elbowroom.experiment.motion.published import KNEE, KNEE_DEVIATION, PELVIC_TILT, corridors

Floats = NDArray[np.float64]

_STANCE_HUMP = (0.05, 0.30)  # of a stride: where the knee gives under the weight
_LATE_STANCE = (0.30, 0.52)  # where it is straight again before it bends for the swing
_HUMP = 3.0  # degrees


@dataclass(frozen=True)
class Curves:
    """A mean stride from heel strike to heel strike, degrees, and what stands out in it."""

    hip: tuple[float, ...]  # (51,) flexion against the pelvis
    knee: tuple[float, ...]  # (51,) flexion
    ankle: tuple[float, ...]  # (51,) dorsiflexion
    loading: float  # the knee's hump in early stance
    straightest: float  # the knee before it bends for the swing
    toe_off: float  # the knee where the foot leaves the ground
    swing_peak: float  # the knee in the swing
    least: float  # the knee at its straightest: below 0 it is bent backward
    humps: int  # tops of the knee's curve in stance
    inside: float  # share of the knee's curve within two deviations of the published mean
    outside: dict[str, float]  # degrees that hip, knee and ankle leave the published corridors by at most


def curves(joints: Posed, skeleton: Skeleton, phase: Floats, duty: float) -> Curves:
    """The mean of left and right strides in a walk with gait phase (N,) and stance part `duty`."""
    both = [
        {name: in_strides(angle, phase + shift) for name, angle in leg_angles(joints, skeleton, side).items()}
        for side, shift in (("left", 0.0), ("right", 0.5))
    ]
    mean = {name: np.concatenate([side[name] for side in both]).mean(axis=0) for name in JOINTS}
    return curves_of(mean, duty)


def curves_of(mean: dict[str, Floats], duty: float) -> Curves:
    """What there is to say of mean strides (51,) of the three joints."""
    knee, parts = mean["knee"], np.linspace(0.0, 1.0, PARTS)
    return Curves(
        hip=tuple(mean["hip"].tolist()),
        knee=tuple(knee.tolist()),
        ankle=tuple(mean["ankle"].tolist()),
        loading=float(knee[_within(parts, *_STANCE_HUMP)].max()),
        straightest=float(knee[_within(parts, *_LATE_STANCE)].min()),
        toe_off=float(np.interp(duty, parts, knee)),
        swing_peak=float(knee[_within(parts, 0.55, 1.0)].max()),
        least=float(knee.min()),
        humps=_tops(knee[_within(parts, 0.0, duty - 0.06)]),
        inside=float((np.abs(knee - KNEE) <= 2.0 * KNEE_DEVIATION).mean()),
        outside={name: _leaves(mean[name], name) for name in JOINTS},
    )


def _within(parts: Floats, low: float, high: float) -> slice:
    return slice(*np.searchsorted(parts, [low - 1e-9, high + 1e-9]).tolist())


def _tops(curve: Floats) -> int:
    """How many times a curve rises by more than three degrees and falls again by as much."""
    tops, low, high, rising = 0, curve[0], curve[0], False
    for value in curve:
        low, high = min(low, value), max(high, value)
        if rising and value < high - _HUMP:
            tops, low, rising = tops + 1, value, False
        elif not rising and value > low + _HUMP:
            high, rising = value, True
    return tops


def _leaves(curve: Floats, name: str) -> float:
    corridor = corridors()[name]
    at = np.interp(corridor.parts, np.linspace(0.0, 1.0, PARTS), curve) + (PELVIC_TILT if name == "hip" else 0.0)
    return float(max(0.0, (corridor.low - at).max(), (at - corridor.high).max()))
