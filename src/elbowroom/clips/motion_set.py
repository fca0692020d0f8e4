"""What an avatar has learnt beside the stock clips: a swing of its own, and motions for the activity graphs."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.clips.stock_clips import arm_swing_goal, stock_clips
from elbowroom.body.dof import LOCAL_GROUPS, LOWERING, DofGroup, clamp, columns_of, followed, side_by_side
from elbowroom.body.gait.cycle import GaitShape
from elbowroom.body.gait.own_steps import CYCLE, OwnSteps
from elbowroom.body.gait.own_stride import PUBLISHED, OwnStride
from elbowroom.clips.style import PLAIN_STYLE, Style
from elbowroom.clips.swing import KEYS, Swing
from elbowroom.errors import InputError

Floats = NDArray[np.float64]

_SPEEDS = (0.4, 0.8, 2.2)  # m/s; with the stock clip at 1.2 m/s every width of the swing is near a vertex
_MOST_CLIPS, _MOST_KEYS = 1_000, 10_000  # that are read from a recording
_MOST_CARRIED, _MOST_DUTY = 1.5, 0.3  # metres and radians; parts of a stride
_LOWERS = LOWERING - DofGroup.WAIST.at.start


@dataclass(frozen=True, eq=False)
class MotionSet:
    """The goal functions' walk and the clips of the activity graphs; without arguments the stock ones."""

    swing: Swing | None = None  # None: the stock arm swing, the waist upright
    dodges: tuple[MotionClip, ...] = ()  # of any local group, beside the stock clips
    style: Style = PLAIN_STYLE  # in which it walks

    @property
    def is_stock_walk(self) -> bool:
        """Whether head and arms go as in the stock walk, and the waist is upright."""
        return self.swing is None and self.style.posture is None

    def own_stride(self, gait: GaitShape) -> OwnStride:
        """How hips and chest are carried on some legs: as in the recorded walk, or as published."""
        return PUBLISHED if self.swing is None else self.swing.own_on(gait)

    @property
    def own_steps(self) -> OwnSteps:
        """How feet go: as in the recorded walk, or in the walking cycle."""
        return CYCLE if self.swing is None else self.swing.steps

    def goal(self, group: DofGroup, phases: ArrayLike, speeds: ArrayLike) -> Floats:
        """What a local group would like to do at gait phases (n,) and forward speeds (n,): (n, size)."""
        goals = self._walk(group, phases, speeds)
        return goals if self.style.posture is None else self.style.posture.of(group, goals)

    def _walk(self, group: DofGroup, phases: ArrayLike, speeds: ArrayLike) -> Floats:
        if self.swing is not None:
            return self.swing.goal(group, phases, speeds)
        if not group.is_arm:
            return np.zeros((len(np.atleast_1d(phases)), group.size))
        return arm_swing_goal(group, phases, speeds)

    def clips(self, group: DofGroup) -> tuple[MotionClip, ...]:
        """The clips of a group's activity graph: the stock clips, the swing at several speeds, the dodges."""
        phases = np.linspace(0.0, 1.0, KEYS + 1)
        swings = (self.goal(group, phases, np.full(len(phases), speed)) for speed in _SPEEDS)
        own = tuple(clip for clip in self.dodges if clip.group is group)
        if self.swing is not None:
            own = (self.swing.clips[group], *own)
        elif not group.is_arm and self.style.posture is None:
            return stock_clips(group) + own
        return (
            stock_clips(group) + tuple(MotionClip("swing", group, phases, swing, loop=True) for swing in swings) + own
        )

    def upright(self) -> "MotionSet":
        """The same without lowering the pelvis."""
        swing = self.swing
        if swing is not None:
            waist = _raised(swing.keys[DofGroup.WAIST])
            swing = replace(swing, keys={**swing.keys, DofGroup.WAIST: waist})
        dodges = (
            replace(clip, configurations=_raised(clip.configurations)) if clip.group is DofGroup.WAIST else clip
            for clip in self.dodges
        )
        return MotionSet(swing, tuple(dodges), self.style)

    def to_dict(self) -> dict[str, Any]:
        """All of it as JSON-ready values; numbers come back to the last bit."""
        swing = self.swing
        return {
            "swing": None
            if swing is None
            else {
                "name": swing.name,
                "speed": swing.speed,
                "keys": {group.name: keys.tolist() for group, keys in swing.keys.items()},
                "carried": {"harmonics": swing.own.harmonics.tolist(), "speed": swing.own.speed},
                "legs": None
                if swing.heights is None
                else {
                    "heights": swing.heights.tolist(),
                    "speed": swing.steps.speed,
                    "duty": swing.steps.duty,
                    "homes": swing.steps.homes.tolist(),
                    "cycle": swing.steps.cycle.tolist(),
                },
            },
            "dodges": [
                {"name": c.name, "group": c.group.name, "times": c.times.tolist(), "keys": c.configurations.tolist()}
                for c in self.dodges
            ],
            "style": asdict(self.style),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], place: str) -> "MotionSet":
        """Read what `to_dict` wrote; raises `InputError`."""
        try:
            swing, dodges, style = data["swing"], data["dodges"], data.get("style")
            if len(dodges) > _MOST_CLIPS:
                raise InputError(f"{place}: {len(dodges)} clips, at most {_MOST_CLIPS} are read")
            return cls(
                None if swing is None else _swing(swing),
                tuple(_clip(dodge) for dodge in dodges),
                PLAIN_STYLE if style is None else Style.from_dict(style),
            )
        except InputError:
            raise
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(f"{place}: the motions are not as they were written ({error!r:.80})") from None


STOCK = MotionSet()


def _raised(configurations: Floats) -> Floats:
    rows = configurations.copy()
    rows[:, _LOWERS] = 0.0
    return rows


def _swing(data: Mapping[str, Any]) -> Swing:
    told = data["keys"]
    later = [group for group in LOCAL_GROUPS if group.value.undoes > 0.0 and group.name not in told]
    keys = {group: _rows(told[group.name], group) for group in LOCAL_GROUPS if group not in later}
    if later:  # written before these groups were planned: they followed
        uppers = followed(side_by_side(keys | {group: np.zeros((KEYS + 1, group.size)) for group in later}))
        keys |= {group: uppers[:, columns_of(group)] for group in later}
    speed = float(data["speed"])
    if any(len(rows) != KEYS + 1 for rows in keys.values()) or not 0.0 < speed < 100.0:
        raise ValueError("swing")
    own, legs = data.get("carried"), data.get("legs")
    beside = () if legs is None else (_table(legs["heights"], (KEYS,)), _own_steps(legs))
    return Swing(str(data["name"]), speed, keys, PUBLISHED if own is None else _own_stride(own), *beside)


def _own_stride(data: Mapping[str, Any]) -> OwnStride:
    return OwnStride(_table(data["harmonics"], PUBLISHED.harmonics.shape), _walking_speed(data["speed"]))


def _own_steps(data: Mapping[str, Any]) -> OwnSteps:
    homes, cycle = (_table(data[name], shape.shape) for name, shape in (("homes", CYCLE.homes), ("cycle", CYCLE.cycle)))
    duty = float(data["duty"])
    if not abs(duty) < _MOST_DUTY:
        raise ValueError("duty")
    return OwnSteps(_walking_speed(data["speed"]), duty, homes, cycle)


def _table(data: Any, shape: tuple[int, ...]) -> Floats:
    table = np.array(data, np.float64)
    if table.shape != shape or not np.abs(table).max() < _MOST_CARRIED:
        raise ValueError("carried")
    return table


def _walking_speed(data: Any) -> float:
    speed = float(data)
    if not 0.0 <= speed < 100.0:
        raise ValueError("speed")
    return speed


def _clip(data: Mapping[str, Any]) -> MotionClip:
    group = DofGroup[data["group"]]
    times, keys = np.array(data["times"], np.float64), _rows(data["keys"], group)
    if group not in LOCAL_GROUPS or times.shape != (len(keys),) or not (np.diff(times) > 0.0).all() or len(keys) < 2:
        raise ValueError("clip")
    return MotionClip(str(data["name"]), group, times, keys)


def _rows(data: Any, group: DofGroup) -> Floats:
    rows = np.array(data, np.float64)
    if rows.ndim != 2 or rows.shape[1] != group.size or len(rows) > _MOST_KEYS or not np.isfinite(rows).all():
        raise ValueError(group.name)
    if np.abs(clamp(group, rows) - rows).max(initial=0.0) > 1e-9:
        raise ValueError(f"{group.name} beyond its limits")
    return rows
