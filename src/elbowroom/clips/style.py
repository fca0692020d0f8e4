"""Styles of walking: how fast, how much of it all, and in what posture; adverbs to the verb "walk".

A style lies between the plain walk, which is that of published gait, and itself taken to the full: by any share of it
(C. Rose, M. F. Cohen & B. Bodenheimer, "Verbs and adverbs: multidimensional motion interpolation", IEEE Computer
Graphics and Applications 18, 1998, from memory). See docs/motion.md for what is measured and what is taste.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.clips.stock_clips import HANGING
from elbowroom.body.dof import DofGroup, clamp
from elbowroom.body.gait.manner import PLAIN, Manner
from elbowroom.clips.style_names import PLAIN_NAME, name_and_share
from elbowroom.errors import InputError

Floats = NDArray[np.float64]

WALK_SPEED = 1.1  # m/s, of the plain walk
_SPEEDS, _WIDEST, _FARTHEST = (0.2, 2.0), 2.5, math.pi / 2  # m/s; times the plain swing; radians


Angles = tuple[float, float, float, float]


@dataclass(frozen=True)
class Posture:
    """How arms and head are held; without arguments as in the plain walk. Raises `InputError` for what is too much."""

    swing: float = 1.0  # of the arms, times that of the plain walk at the same speed
    arms: Angles = (0.0, 0.0, 0.0, 0.0)  # radians added to flexion, abduction, rotation, elbow
    nod: float = 0.0  # radians that the head is lower

    def __post_init__(self) -> None:
        _check("swing", self.swing, 0.0, _WIDEST)
        for angle in (*self.arms, self.nod):
            _check("posture", angle, -_FARTHEST, _FARTHEST)

    def of(self, group: DofGroup, goals: Floats) -> Floats:
        """Goals (n, size) of a local group in the plain walk, as they are in this posture."""
        if group.is_arm:
            return clamp(group, HANGING + np.array(self.arms) + self.swing * (goals - HANGING))
        if group is DofGroup.HEAD:
            return clamp(group, goals + np.array([self.nod, 0.0]))
        return goals

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> "Posture":
        """Read what `asdict` made; raises KeyError, TypeError, ValueError or `InputError`."""
        return cls(float(data["swing"]), _angles([float(angle) for angle in data["arms"]]), float(data["nod"]))


@dataclass(frozen=True)
class Style:
    """A way to walk; without arguments the plain one. Raises `InputError` for what no body could show."""

    name: str = PLAIN_NAME  # by which it is chosen
    speed: float = WALK_SPEED  # m/s that it likes to walk
    manner: Manner = PLAIN  # how hips and chest are carried
    posture: Posture | None = None  # None: that of the plain walk

    def __post_init__(self) -> None:
        _check("speed", self.speed, *_SPEEDS)

    def by(self, share: float) -> "Style":
        """So much of this style, 0 to 1: 0 is the plain walk, as far as numbers go."""
        _check("style", share, 0.0, 1.0)
        own, plain = self.posture or Posture(), Posture()
        posture = Posture(
            _between(plain.swing, own.swing, share),
            _angles([share * angle for angle in own.arms]),
            share * own.nod,
        )
        full, none = asdict(self.manner), asdict(PLAIN)
        manner = Manner(**{name: _between(none[name], full[name], share) for name in none})
        return Style(f"{self.name}:{share:g}", _between(WALK_SPEED, self.speed, share), manner, posture)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> "Style":
        """Read what `asdict` made; raises KeyError, TypeError, ValueError or `InputError`."""
        posture = data["posture"]
        return cls(
            str(data["name"]),
            float(data["speed"]),
            Manner.from_dict(data["manner"]),
            None if posture is None else Posture.from_dict(posture),
        )


def _angles(values: Sequence[float]) -> Angles:
    flexion, abduction, rotation, elbow = values
    return flexion, abduction, rotation, elbow


def _arms(flexion: float, abduction: float, rotation: float, elbow: float) -> Angles:
    """Degrees as radians."""
    return _angles(np.deg2rad([flexion, abduction, rotation, elbow]).tolist())


def _between(plain: float, own: float, share: float) -> float:
    return plain + share * (own - plain)


def _check(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise InputError(f"{name}: {value:g} is not between {low:g} and {high:g}")


PLAIN_STYLE = Style()

STYLES: Mapping[str, Style] = {
    style.name: style
    for style in (
        PLAIN_STYLE,
        Style(
            "relaxed", 0.95,
            Manner(sway=1.3, bob=1.2, turn=1.1, list=1.35, chest=1.1, lean=math.radians(-2.0)),
            Posture(0.9, _arms(-1.0, 2.0, 0.0, -3.0), math.radians(1.0)),
        ),
        Style(
            "brisk", 1.5,
            Manner(sway=0.85, bob=1.3, turn=1.3, chest=1.4, lean=math.radians(3.0)),
            Posture(1.25, _arms(4.0, 2.0, 0.0, 22.0), math.radians(-1.0)),
        ),
        Style(
            "careful", 0.6,
            Manner(sway=1.15, bob=0.4, ripple=0.5, turn=0.5, list=0.6, chest=0.4, nods=0.5, lean=math.radians(4.0)),
            Posture(0.35, _arms(8.0, 10.0, 0.0, 20.0), math.radians(12.0)),
        ),
        Style(
            "old", 0.75,
            Manner(sway=1.3, bob=0.5, ripple=0.7, turn=0.6, list=0.7, chest=0.4, lean=math.radians(12.0)),
            Posture(0.55, _arms(12.0, 4.0, 5.0, 18.0), math.radians(6.0)),
        ),
        Style(
            "child", 1.2,
            Manner(sway=1.4, bob=2.5, ripple=1.2, turn=1.5, list=1.4, chest=1.6, nods=1.6),
            Posture(1.45, _arms(0.0, 5.0, 0.0, 8.0), math.radians(-4.0)),
        ),
    )
}  # fmt: skip


def style_named(text: str) -> Style:
    """A stock style by NAME, or so much of it by NAME:SHARE, as `old:0.5`; raises `InputError`."""
    name, share = name_and_share(text)
    return STYLES[name] if share is None else STYLES[name].by(share)
