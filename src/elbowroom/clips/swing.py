"""One stride of a recorded walk as a function of the gait phase, to be that of any walk.

The upper body is the goal of planning; how hips and chest are carried beside that is shown where there is room.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.clips.stock_clips import arm_swing_goal
from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, DofGroup, clamp, columns_of
from elbowroom.body.gait.own_stride import GROWTH, PUBLISHED, WIDEST, OwnStride
from elbowroom.clips.carried import own_stride
from elbowroom.clips.planning_motion import PlanningMotion, upper_body
from elbowroom.errors import InputError

Floats = NDArray[np.float64]

KEYS = 32  # of a stride
_SLOWEST = 0.15  # m/s


@dataclass(frozen=True, eq=False)
class Swing:
    """The upper body over one stride, its phase 0 at the left heel's strike."""

    name: str
    speed: float  # m/s of the recorded walk
    keys: Mapping[DofGroup, Floats]  # (KEYS + 1, size) of each local group; the last key repeats the first
    own: OwnStride = PUBLISHED  # hips and chest beside these

    @cached_property
    def clips(self) -> Mapping[DofGroup, MotionClip]:
        """The stride as recorded, as clips whose time is the gait phase."""
        phases = np.linspace(0.0, 1.0, KEYS + 1)
        return {group: MotionClip(self.name, group, phases, keys, loop=True) for group, keys in self.keys.items()}

    def goal(self, group: DofGroup, phases: ArrayLike, speeds: ArrayLike) -> Floats:
        """Configurations (n, size) at gait phases (n,) and forward speeds (n,) in m/s.

        At the recorded speed they are those recorded; slower they shrink towards the body at rest, faster they grow a
        little. Backward the stride runs half a stride ahead, as the legs do.
        """
        phase, speed = np.broadcast_arrays(np.asarray(phases, np.float64), np.asarray(speeds, np.float64))
        rest = resting(group)
        gain = (1.0 - np.exp(-np.abs(speed) / GROWTH)) / (1.0 - np.exp(-self.speed / GROWTH))
        recorded = self.clips[group].sample(phase + np.where(speed < 0.0, 0.5, 0.0))
        return clamp(group, rest + np.minimum(gain, WIDEST)[..., None] * (recorded - rest))


def resting(group: DofGroup) -> Floats:
    """The group of a body that stands relaxed: (size,)."""
    if not group.is_arm:
        return np.zeros(group.size)
    posture: Floats = arm_swing_goal(group, np.zeros(1), np.zeros(1))[0]
    return posture


def swing_of(motion: PlanningMotion, place: str) -> Swing:
    """The mean stride of a walk; raises `InputError` if the clip holds none."""
    strides = motion.track.strides
    if not strides.walks or strides.speed < _SLOWEST:
        raise InputError(f"{place}: nobody walks in this clip (two steps and more are needed), so it gives no swing")
    phases, rows = _span(motion)
    if phases[-1] - phases[0] < 1.0:
        raise InputError(f"{place}: the clip holds {phases[-1] - phases[0]:.2f} of a stride, a whole one is needed")
    starts = np.arange(phases[0], phases[-1] - 1.0 + 1e-9, 0.25)
    mean = np.mean([_closed_stride(phases, rows, start) for start in starts], axis=0)
    keys = np.concatenate([mean, mean[:1]])
    pace = float(np.diff(strides.phases).mean()) / motion.frame_time
    own = own_stride(mean[:, LOCAL:], pace, motion.gait.scale, strides.speed)
    return Swing(motion.name, strides.speed, {g: clamp(g, keys[:, columns_of(g)]) for g in LOCAL_GROUPS}, own)


def _span(motion: PlanningMotion) -> tuple[Floats, Floats]:
    """Increasing gait phases, and upper bodies and how they are carried: from strike to strike, or a loop twice."""
    strides, rows = motion.track.strides, np.hstack([upper_body(motion), motion.carried])
    if strides.loop:
        phases = strides.phases[: strides.loop]
        round_ = max(1, round(float(phases[-1] - phases[0]) * strides.loop / (strides.loop - 1)))
        return np.concatenate([phases, phases + round_]), np.tile(rows[: strides.loop], (2, 1))
    first, last = (round(strides.strikes[k][1]) for k in (0, -1))
    return strides.phases[first : last + 1], rows[first : last + 1]


def _closed_stride(phases: Floats, rows: Floats, start: float) -> Floats:
    """The stride (KEYS, n) that begins at a phase; what its end is away from its beginning is spread over it."""
    keys = np.arange(KEYS) / KEYS
    at = start + np.mod(keys - start, 1.0)
    columns = [np.interp(np.append(at, [start, start + 1.0]), phases, column) for column in rows.T]
    table = np.stack(columns, axis=1)
    gap = table[-1] - table[-2]
    stride: Floats = table[:-2] - np.outer(at - start - 0.5, gap)
    return stride
