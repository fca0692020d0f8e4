"""The clips that come with the package, and the arms' swing as a function of gait phase and speed."""

from functools import cache
from importlib import resources

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.clips.clip_data import ClipData, parse_clips
from elbowroom.body.dof import LOCAL_GROUPS, DofGroup
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.jit import exact_kernel, inner_exact_kernel

Floats = NDArray[np.float64]

_FILES = tuple(f"{part}.json" for part in dict.fromkeys(group.value.clips for group in LOCAL_GROUPS))
_SWING = "arm_swing"
HANGING = np.deg2rad([-2.0, 6.0, 3.0, 10.0])  # the relaxed arm of a body that stands

# Where two swings a stride (each arm with every step) give way to one (each arm with the other leg): some 0.8 m/s.
# D. Webb, R. H. Tuttle & M. Baksh, Am. J. Phys. Anthropol. 93 (1994); R. C. Wagenaar & R. E. A. van Emmerik,
# J. Biomech. 33 (2000).
_CROSSOVER, _CROSSOVER_WIDTH = 0.80, 0.30  # m/s
_FULL, _GROWTH = (
    1.5,
    1.1,
)  # the swing is the clip's at 1.2 m/s, half of it at some 0.4 m/s (Kuhtz-Buschbeck & Jing 2012)


@cache
def _stock() -> tuple[ClipData, ...]:
    folder = resources.files("elbowroom.body") / "data" / "clips"
    return tuple(clip for name in _FILES for clip in parse_clips((folder / name).read_text("utf-8"), name))


@cache
def stock_clips(group: DofGroup) -> tuple[MotionClip, ...]:
    """The package's clips of a group, each of which starts at the hanging arm or the upright trunk.

    An arm's first clip is its swing. Mirrored gestures have equal values on both sides.
    """
    return tuple(
        MotionClip(clip.name, group, clip.times, clip.configurations, clip.loop)
        for clip in _stock()
        if group in clip.groups
    )


@cache
def arm_swing(group: DofGroup) -> MotionClip:
    """An arm's swing over one stride; time is the gait phase in strides, 0 = left heel strike.

    The angles are those of a walk at 1.2 m/s. Raises ValueError if the group is not an arm.
    """
    if not group.is_arm:
        raise ValueError(f"{group.name} is not an arm")
    clip = next(clip for clip in stock_clips(group) if clip.name == _SWING)
    if group is DofGroup.LEFT_ARM:
        return clip
    times = np.linspace(0.0, 1.0, len(clip.times))
    return MotionClip(clip.name, group, times, clip.sample(times + 0.5), loop=True)


def arm_swing_goal(group: DofGroup, phases: ArrayLike, speeds: ArrayLike) -> Floats:
    """Configurations (n, 4) of the natural arm at gait phases (n,) in strides and forward speeds (n,) in m/s.

    The swing grows from the hanging arm at rest. Below some 0.8 m/s the arms swing twice a stride, above once, opposite
    to their leg; in between the two are mixed. Backward (negative speed) the swing follows the legs.
    """
    if not group.is_arm:
        raise ValueError(f"{group.name} is not an arm")
    phase, speed = np.asarray(phases, np.float64), np.asarray(speeds, np.float64)
    if phase.shape != speed.shape:
        phase, speed = np.broadcast_arrays(phase, speed)
    starts, cubics = arm_swing(DofGroup.LEFT_ARM).cubics
    ahead = 0.0 if group is DofGroup.LEFT_ARM else 0.5
    goal = _swings(starts, cubics, HANGING, phase.ravel() + ahead, speed.ravel())
    return goal.reshape(*phase.shape, len(HANGING))


@exact_kernel
def _swings(starts: Floats, cubics: Floats, hanging: Floats, phases: Floats, speeds: Floats) -> Floats:
    """`arm_swing_goal` (n, 4) at phases and speeds (n,): curves `cubics` (4, K, 4) from `starts` (K+1,) on."""
    out = np.empty((phases.shape[0], hanging.shape[0]))
    for n in range(phases.shape[0]):
        swing_into(starts, cubics, hanging, phases[n], speeds[n], out[n])
    return out


@inner_exact_kernel
def swing_into(starts: Floats, cubics: Floats, hanging: Floats, phase: float, speed: float, out: Floats) -> None:
    """One row of `arm_swing_goal`, written to the first of `out`; the left arm's `cubics` are the right one's half a
    stride on."""
    pace = abs(speed)
    phase += 0.5 if speed < 0.0 else 0.0
    single, width = smoothstep((pace - _CROSSOVER) / _CROSSOVER_WIDTH + 0.5), _FULL * (1.0 - np.exp(-pace / _GROWTH))
    for once in range(2):
        time = phase if once == 1 else 2.0 * phase
        share = width * (single if once == 1 else 1.0 - single)
        time -= np.floor(time)
        k = 0
        while k < cubics.shape[1] - 1 and starts[k + 1] <= time:
            k += 1
        u = time - starts[k]
        for i in range(hanging.shape[0]):
            value = ((cubics[0, k, i] * u + cubics[1, k, i]) * u + cubics[2, k, i]) * u + cubics[3, k, i]
            out[i] = share * (value - hanging[i]) + (out[i] if once == 1 else hanging[i])
