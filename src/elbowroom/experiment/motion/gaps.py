"""Two walls with a gap between them: when do the shoulders turn, and how near do they come?"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.motion.scripts import Script, at_speed, strokes
from elbowroom.experiment.motion.trunk import chest_joint, turned_about
from elbowroom.experiment.motion.walked import RATE, Walked, walk
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

TURNED = 20.0  # degrees of the shoulders against the way: who turns so far is said to turn (Franchak et al. 2012)
_AT, _THICK, _LONG, _HIGH = 4.0, 0.1, 2.0, 2.2  # metres: where the walls stand, and their size
_NEAR = 0.3  # metres before and behind the walls: what is passed
_SECONDS = 7.0


@dataclass(frozen=True)
class PassedGap:
    """How one gap was passed."""

    ratio: float  # of the gap to the width of the shoulders
    width: float  # metres
    passed: bool
    turn: float  # degrees, of the shoulders against the way ahead, at most
    clearance: float | None  # centimetres, the least; None where the gap was not reached
    speed: float | None  # of the walking speed, in the mean through the gap


@dataclass(frozen=True)
class Narrow:
    """All gaps."""

    shoulders: float  # metres, the width of the shoulders with the arms' tops
    onset: float | None  # the widest gap, in shoulder widths, in which they turn
    passages: tuple[PassedGap, ...]


def shoulder_width(humanoid: Humanoid) -> float:
    """How broad a body is at the shoulders, metres: by their capsule, or by the upper arms where it has none."""
    capsules, skeleton = humanoid.capsules, humanoid.skeleton
    if "shoulders" in capsules.names:
        at = capsules.names.index("shoulders")
        return float(abs(capsules.starts[at, 0] - capsules.ends[at, 0]) + 2.0 * capsules.radii[at])
    arms = [skeleton.positions[skeleton.index(f"{side}UpperArm"), 0] for side in ("left", "right")]
    return float(arms[0] - arms[1] + 2.0 * capsules.radii[capsules.names.index("leftUpperArm")])


def walls(width: float) -> Scene:
    """Walls across the way, 4 m ahead, that leave a gap of this width in metres."""
    side = 0.5 * width + 0.5 * _LONG
    sizes = [_LONG, _HIGH, _THICK]
    obstacles = [
        {"type": "box", "center": [x, 0.5 * _HIGH, _AT], "size": sizes, "name": name}
        for name, x in (("left wall", side), ("right wall", -side))
    ]
    return Scene.of(f"gap {width:.3f}", obstacles, finish=(0.0, _AT + 1.5))


def pass_gap(humanoid: Humanoid, ratio: float) -> PassedGap:
    """Walk through a gap of so many shoulder widths."""
    width, speed = ratio * shoulder_width(humanoid), RootMotionSettings().walk_speed
    hand = strokes((_SECONDS, at_speed(speed)))
    walked = walk(humanoid, Script(f"gap {ratio:g}", walls(width), hand, _SECONDS))
    near = np.abs(walked.roots[:, 1] - _AT) < _NEAR
    passed = bool(walked.roots[-1, 1] > _AT + _NEAR)
    return PassedGap(
        ratio=ratio,
        width=width,
        passed=passed,
        turn=float(np.abs(shoulder_turns(walked, humanoid)).max()),
        clearance=100.0 * float(walked.clearances[near].min()) if near.any() else None,
        speed=2.0 * _NEAR * RATE / float(near.sum()) / speed if passed else None,
    )


def shoulder_turns(walked: Walked, humanoid: Humanoid) -> Floats:
    """How far the shoulders (N,) are turned against straight ahead, degrees."""
    chest = walked.joints.rotations[:, chest_joint(humanoid.skeleton)]
    turns: Floats = turned_about(chest, np.zeros(len(chest)))[:, 0]
    return turns


def narrow(humanoid: Humanoid, passages: tuple[PassedGap, ...]) -> Narrow:
    """What the gaps say together."""
    return Narrow(shoulder_width(humanoid), onset(passages), passages)


def onset(passages: tuple[PassedGap, ...]) -> float | None:
    """The widest gap in which the shoulders turn, in shoulder widths, between two that were walked by proportion."""
    rows = sorted(((p.ratio, p.turn) for p in passages), reverse=True)
    if not rows or rows[0][1] >= TURNED:
        return rows[0][0] if rows else None
    for (wide, less), (tight, more) in pairwise(rows):
        if more >= TURNED:
            return wide - (wide - tight) * (TURNED - less) / (more - less)
    return None
