"""The strides of a walk: when each foot strikes the ground, and how fast the ground goes by.

A heel strikes where the ankle is farthest ahead of the hips: J. A. Zeni, J. G. Richards & J. S. Higginson, Gait &
Posture 27 (2008). This holds on the ground as well as on a treadmill and for a walk on the spot.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.stride import phase_rate
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.geometry.quaternion import angle_between

Floats = NDArray[np.float64]

_STEP = 0.12  # of the hips' height: an ankle that swings less far ahead does not walk
_LIFT = 0.06  # of the hips' height: a foot that is lifted less does not march
_MARCHES = 4  # strikes at least of a march
_EVEN = 0.3  # of a stride: no step of a march is shorter
_SOONEST = 0.35  # seconds between two strikes of one foot
_LOW = 0.2  # of a foot's range of height: so low it stands
_SPOT = 0.3  # of the speed that the feet show: a walk that gets on less fast is one on the spot
_SLOWEST, _FASTEST = 0.15, 2.5  # m/s: who is slower does not walk
_LIMP = 0.2  # of a stride: no step is shorter


@dataclass(frozen=True, eq=False)
class Strides:
    """Heel strikes and gait phase."""

    strikes: tuple[tuple[float, float], ...]  # (phase in strides, frame) in order: whole = left heel, half = right
    phases: Floats  # (F,) gait phase in strides; constant where nobody walks
    speed: float  # m/s over the ground, by the standing foot; 0 where nobody walks
    on_the_spot: bool  # the hips stay while the feet walk
    loop: int  # frames after which the motion begins anew; 0 for one that ends

    @property
    def walks(self) -> bool:
        """Whether there are at least two steps."""
        return len(self.strikes) >= 3


def strides_of(motion: BodyMotion, ground: Floats, heading: Floats) -> Strides:
    """Find the strides of a motion with the root's way (F, 2) and heading (F,)."""
    ahead = np.stack([_ahead(motion, heading, side) for side in ("left", "right")])
    closed = loop_frames(motion)
    marks: list[tuple[float, int]] = []
    for side in range(2):
        marks += [(float(at), side) for at in _peaks(ahead[side], _STEP, motion, closed)]
    strikes = _alternating(sorted(marks))
    speed = _ground_speed(motion, ahead) if len(strikes) >= 3 else 0.0
    way = float(np.linalg.norm(np.diff(ground, axis=0), axis=1).sum())
    if speed < _SLOWEST or not _regular(strikes):
        strikes, speed = _marched(motion, closed)
        if speed < _SLOWEST or way > _SPOT * speed * motion.duration:
            return Strides((), np.zeros(len(motion)), 0.0, False, closed)
    frames = np.array([frame for _, frame in strikes])
    steps = np.array([phase for phase, _ in strikes])
    on_the_spot = bool(way < _SPOT * speed * motion.duration)
    return Strides(strikes, _phases(len(motion), frames, steps), speed, on_the_spot, closed)


def _marched(motion: BodyMotion, closed: int) -> tuple[tuple[tuple[float, float], ...], float]:
    """Strikes where the feet are only lifted, in turn: they come down after each lift; and the speed of such steps.

    The speed is that of a walk with as many steps. No strikes and no speed where nobody marches.
    """
    marks: list[tuple[float, int]] = []
    for side, name in enumerate(("left", "right")):
        height = motion.position(f"{name}Foot")[:, 1]
        low = float(np.percentile(height, 5.0)) + _LOW * float(np.ptp(np.percentile(height, [5.0, 95.0])))
        for peak in _peaks(height, _LIFT, motion, closed):
            after = np.roll(height, -int(peak)) if closed else height[int(peak) :]
            down = np.flatnonzero(after <= low)
            if len(down):
                marks.append((float(peak + down[0]), side))
    strikes = _alternating(sorted(marks))
    if len(strikes) < _MARCHES or not _regular(strikes, _EVEN):
        return (), 0.0
    rate = (strikes[-1][0] - strikes[0][0]) / ((strikes[-1][1] - strikes[0][1]) * motion.frame_time)
    speeds = np.linspace(_SLOWEST, _FASTEST, 64)
    rates = np.array([phase_rate(float(speed), 0.0, 0.0) for speed in speeds])
    return strikes, float(speeds[int(np.argmin(np.abs(rates - rate)))])


def loop_frames(motion: BodyMotion) -> int:
    """After how many frames the motion begins anew, if its end fits its beginning; else 0."""
    if len(motion) < 8:
        return 0
    turns = motion.turns
    last = float(angle_between(turns[-1], turns[0]).mean())
    step = float(np.median(angle_between(turns[1:], turns[:-1]).mean(axis=1)))
    spread = float(angle_between(turns, turns[:1]).mean(axis=1).max())
    if last > 0.25 * spread:
        return 0
    if last <= 0.3 * step:
        return len(motion) - 1
    return len(motion) if last <= 1.6 * step else 0


def _ahead(motion: BodyMotion, heading: Floats, side: str) -> Floats:
    """How far (F,) an ankle is ahead of the hips, metres."""
    away = motion.position(f"{side}Foot") - motion.hips
    return away[:, 0] * np.sin(heading) + away[:, 2] * np.cos(heading)


def _peaks(ahead: Floats, least: float, motion: BodyMotion, closed: int) -> Floats:
    """Frames at which an ankle is farthest ahead or up, by `least` hip heights; of a loop those of one round."""
    from scipy.signal import find_peaks  # takes longer to import than a whole start

    size = least * float(motion.rest[0, 1])
    distance = max(int(_SOONEST / motion.frame_time), 1)
    if not closed:
        return np.asarray(find_peaks(ahead, prominence=size, distance=distance)[0], np.float64)
    rounds = np.tile(ahead[:closed], 3)
    found = find_peaks(rounds, prominence=size, distance=min(distance, max(closed // 2, 1)))[0]
    inside: Floats = found[(found >= closed) & (found < 2 * closed + closed // 2 + 1)].astype(np.float64) - closed
    return inside


def _alternating(marks: list[tuple[float, int]]) -> tuple[tuple[float, float], ...]:
    """The strikes with their phase, left and right in turn; of two of one foot in a row the later one counts."""
    kept: list[tuple[float, int]] = []
    for mark in marks:
        if kept and kept[-1][1] == mark[1]:
            kept[-1] = mark
        else:
            kept.append(mark)
    first = 0.5 * kept[0][1] if kept else 0.0
    return tuple((first + 0.5 * k, frame) for k, (frame, _) in enumerate(kept))


def _regular(strikes: tuple[tuple[float, float], ...], least: float = _LIMP) -> bool:
    """Whether most steps take their part of the stride."""
    steps = np.diff([frame for _, frame in strikes])
    shares = steps[1:] / (steps[1:] + steps[:-1])
    return bool(np.median(np.minimum(shares, 1.0 - shares)) > least)


def _phases(count: int, frames: Floats, steps: Floats) -> Floats:
    """Phase (F,) between the strikes, and beyond them at their mean pace."""
    pace = (steps[-1] - steps[0]) / (frames[-1] - frames[0])
    at = np.arange(count, dtype=np.float64)
    inside = np.interp(at, frames, steps)
    before, after = np.minimum(at - frames[0], 0.0), np.maximum(at - frames[-1], 0.0)
    phases: Floats = inside + pace * (before + after)
    return phases


def _ground_speed(motion: BodyMotion, ahead: Floats) -> float:
    """How fast the standing foot goes back under the hips, m/s: the median over the frames in which a foot is low."""
    speeds = []
    for side, row in zip(("left", "right"), ahead, strict=True):
        height = motion.position(f"{side}Foot")[:, 1]
        down, up = np.percentile(height, [5.0, 95.0])
        low = height <= down + _LOW * max(float(up - down), 1e-6)
        speeds.append(-np.gradient(row, motion.frame_time)[low])
    return max(float(np.median(np.concatenate(speeds))), 0.0)
