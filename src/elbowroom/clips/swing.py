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
from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, LOWERING, DofGroup, clamp, columns_of
from elbowroom.body.gait.carriage import AHEAD, ASIDE, POSING
from elbowroom.body.gait.cycle import GaitShape
from elbowroom.body.gait.lowered_hips import hips_sinks
from elbowroom.body.gait.own_steps import CYCLE, PATH, OwnSteps
from elbowroom.body.gait.own_stride import GROWTH, PUBLISHED, WIDEST, OwnStride, at_height
from elbowroom.body.root import WITH_FEET
from elbowroom.clips.carried import displaced, own_stride
from elbowroom.clips.planning_motion import PlanningMotion, upper_body
from elbowroom.clips.recorded_steps import SPAN, around, recorded_steps
from elbowroom.errors import InputError

Floats = NDArray[np.float64]

KEYS = 32  # of a stride
_SLOWEST = 0.15  # m/s
_FINE = 4 * KEYS  # moments of a stride that are looked at
_LOWERS = columns_of(DofGroup.WAIST).start + LOWERING - DofGroup.WAIST.at.start
_CARRIAGE, _HEIGHT, _LEGS = slice(LOCAL, LOCAL + POSING), LOCAL + POSING, slice(LOCAL + POSING + 1, None)  # of a row


@dataclass(frozen=True, eq=False)
class Swing:
    """The upper body over one stride, its phase 0 at the left heel's strike."""

    name: str
    speed: float  # m/s of the recorded walk
    keys: Mapping[DofGroup, Floats]  # (KEYS + 1, size) of each local group; the last key repeats the first
    own: OwnStride = PUBLISHED  # hips and chest beside these
    heights: Floats | None = None  # (KEYS,) of the hips beside those over a straight leg, metres of a standard leg
    steps: OwnSteps = CYCLE  # and the feet

    def own_on(self, gait: GaitShape) -> OwnStride:
        """How hips and chest go on some legs."""
        if self.heights is None:
            return self.own
        return at_height(
            self.own, self.heights, self.keys[DofGroup.WAIST][:KEYS, _LOWERS - columns_of(DofGroup.WAIST).start], gait
        )

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
    pace, gait = float(np.diff(strides.phases).mean()) / motion.frame_time, motion.gait
    mean[:, _CARRIAGE] = displaced(mean[:, _CARRIAGE], pace)
    legs = mean[:, _LEGS].reshape(_FINE, 2, PATH + SPAN)
    feet = _from_root(legs[..., :PATH], mean[:, _CARRIAGE])
    feet[..., 1] -= hips_sinks(gait.half_leg, np.zeros(_FINE), mean[:, _LOWERS].copy())[:, [1]]
    steps, ground, lands = recorded_steps(feet, legs[..., PATH:], gait, strides.speed)
    mean[:, _HEIGHT] = (mean[:, _HEIGHT] - ground) / gait.scale
    mean = around(mean, lands + np.arange(KEYS) / KEYS)
    keys = np.concatenate([mean, mean[:1]])
    return Swing(
        motion.name,
        strides.speed,
        {group: clamp(group, keys[:, columns_of(group)]) for group in LOCAL_GROUPS},
        own_stride(mean[:, _CARRIAGE], gait.scale, strides.speed),
        mean[:, _HEIGHT],
        steps,
    )


def _from_root(feet: Floats, carriage: Floats) -> Floats:
    """Feet (n, 2, PATH) that are told from the hips as seen from the root."""
    seen = feet.copy()
    seen[..., 0] += carriage[:, [ASIDE - WITH_FEET]]
    seen[..., 1] += carriage[:, [AHEAD - WITH_FEET]]
    return seen


def _span(motion: PlanningMotion) -> tuple[Floats, Floats]:
    """Increasing gait phases, and rows of all that is seen of the body: from strike to strike, or a loop twice."""
    strides, legs = motion.track.strides, np.concatenate([motion.feet, motion.spans], axis=2)
    rows = np.hstack([upper_body(motion), motion.carried, motion.heights[:, None], legs.reshape(len(motion), -1)])
    if strides.loop:
        phases = strides.phases[: strides.loop]
        round_ = max(1, round(float(phases[-1] - phases[0]) * strides.loop / (strides.loop - 1)))
        return np.concatenate([phases, phases + round_]), np.tile(rows[: strides.loop], (2, 1))
    first, last = (round(strides.strikes[k][1]) for k in (0, -1))
    return strides.phases[first : last + 1], rows[first : last + 1]


def _closed_stride(phases: Floats, rows: Floats, start: float) -> Floats:
    """The stride (_FINE, n) that begins at a phase; what its end is away from its beginning is spread over it."""
    keys = np.arange(_FINE) / _FINE
    at = start + np.mod(keys - start, 1.0)
    columns = [np.interp(np.append(at, [start, start + 1.0]), phases, column) for column in rows.T]
    table = np.stack(columns, axis=1)
    gap = table[-1] - table[-2]
    stride: Floats = table[:-2] - np.outer(at - start - 0.5, gap)
    return stride
