"""A continuous random motion of waist and arms along a course."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.dof import ARMS, LOCAL, LOWERING, DofGroup, clamp, columns_of, followed
from elbowroom.control.plans.canned import standing_posture
from elbowroom.experiment.gauntlet import levels
from elbowroom.experiment.gauntlet.draw import GRAIN, Draw, Range
from elbowroom.experiment.gauntlet.line import smoothstep
from elbowroom.experiment.gauntlet.self_clearance import SelfClearance
from elbowroom.experiment.gauntlet.speeds import WALK_SPEED, HumanSpeeds

Floats = NDArray[np.float64]

ArmRanges = tuple[Range, Range, Range, Range]

_MOVED = DofGroup.WAIST, *ARMS
WAIST, LEFT, RIGHT = (columns_of(group) for group in _MOVED)  # columns of an upper body (LOCAL,)
_BEND, _TWIST, _ABDUCTIONS = WAIST.start, WAIST.start + 1, [LEFT.start + 1, RIGHT.start + 1]
# What is drawn of it: a certificate's pelvis is never lowered, and what else there is follows the waist.
DRAWN = np.array([j for j in np.r_[WAIST, LEFT, RIGHT] if j != WAIST.start + LOWERING - DofGroup.WAIST.at.start])

_BENT, _LEANING = (0.75, 1.25), (0.60, 0.95)  # forward bend alone, and with a twist
_TWISTED = (0.50, 0.78)
_LITTLE = (-0.08, 0.08)  # what a group does that is not asked
_AWAY = (0.0, 0.35)  # abduction of an arm that is not asked: a bent or twisted trunk takes it along
_DRIFT = (-0.10, 0.10)  # change of an asked component during a passage
# Ranges of flexion, abduction, internal rotation, elbow: whatever an arm does in front of and beside the body; raised
# ahead; raised to the side; folded before the chest; and how the arms make a twisted body slim: the one on the side to
# which the trunk turns hangs a little back, the other a little ahead.
_ANY_ARM = ((-0.70, 2.60), (-0.40, 2.40), (-1.20, 1.00), (0.0, 2.40))
_RAISED_ARM = ((0.90, 2.60), (-0.40, 0.60), (-0.90, 0.90), (0.0, 2.20))
_ASIDE_ARM = ((-0.40, 1.00), (0.90, 2.20), (-1.20, 0.90), (0.0, 2.20))
_FOLDED_ARM = ((0.10, 1.20), (-0.45, 0.15), (0.0, 1.10), (0.9, 2.45))
_BACK_ARM = ((-0.50, 0.00), (-0.20, 0.15), (-0.30, 0.90), (0.0, 0.35))
_AHEAD_ARM = ((0.00, 0.35), (-0.30, 0.00), (0.00, 0.90), (0.0, 0.90))
_FREE_ARMS = (_RAISED_ARM, _ASIDE_ARM, _FOLDED_ARM, _ANY_ARM)
_NARROW_ARMS = (_FOLDED_ARM, _BACK_ARM, _RAISED_ARM, _ANY_ARM)
_ARMS = {  # what arms do in a passage that asks for both
    levels.BOTH_ARMS: _FREE_ARMS,
    levels.BEND_ARMS: _FREE_ARMS,
    levels.TWIST_ARMS: _NARROW_ARMS,
    levels.BEND_TWIST: _NARROW_ARMS,
}

_POSTURES = 60  # draws for one passage
_DRIFTS = 6  # draws for the end of one
_STEPS = 24  # poses that are checked for a draw: half on the way to it, half in it
_TRANSITION_STEP = 0.03  # metres between the checked moments of a motion
_APPROACH = 1.6  # metres before the first passage where the motion begins; after the last it stays as it is


@dataclass(frozen=True)
class Passage:
    """A part of the way through which the body has to be held."""

    begin: float  # metres along the line
    end: float
    asks: str
    long: bool
    side: int  # 1 left, -1 right: of the arm asked, or of the twist

    @property
    def middle(self) -> float:
        """Half way through."""
        return 0.5 * (self.begin + self.end)


@dataclass(frozen=True, eq=False)
class UpperBodyMotion:
    """Upper bodies as a function of the way: through key postures, resting at each, C1."""

    way: Floats  # (K,) metres along the line, increasing
    postures: Floats  # (K, LOCAL) radians

    def at(self, s: ArrayLike) -> Floats:
        """Upper bodies (N, LOCAL) at ways (N,)."""
        place = np.asarray(s, np.float64)
        k = np.clip(np.searchsorted(self.way, place, side="right") - 1, 0, len(self.way) - 2)
        part = smoothstep((place - self.way[k]) / (self.way[k + 1] - self.way[k]))[:, None]
        return (1.0 - part) * self.postures[k] + part * self.postures[k + 1]


def draw_motion(
    draw: Draw, passages: tuple[Passage, ...], check: SelfClearance, speeds: HumanSpeeds
) -> UpperBodyMotion | None:
    """A motion that is within the limits of joints and speeds, and does not run into itself; None if none was drawn."""
    hanging = np.round(standing_posture(np.zeros(7)), GRAIN)
    way, postures = [max(0.0, passages[0].begin - _APPROACH)], [hanging]
    for passage in passages:
        room = passage.begin - way[-1]
        held = _posture(draw, passage, postures[-1], hanging, check, farthest(speeds, room))
        if held is None:
            return None
        way += [passage.begin, passage.end]
        postures += [held, _drifted(draw, held, hanging, check, farthest(speeds, passage.end - passage.begin))]
    motion = UpperBodyMotion(np.array(way), np.array(postures))
    return motion if _is_clear(motion, check) else None


def farthest(speeds: HumanSpeeds, length: float) -> Floats:
    """How far waist, left and right arm (3,) may move along `length` metres of a walk at full speed."""
    time = length / WALK_SPEED
    waist = min(speeds.waist * time / 1.5, speeds.waist_acceleration * time**2 / 6.0)
    arm = min(speeds.arm * time / 1.5, speeds.arm_acceleration * time**2 / 6.0)
    return np.array([waist, arm, arm])


def _posture(
    draw: Draw, passage: Passage, before: Floats, hanging: Floats, check: SelfClearance, reach: Floats
) -> Floats | None:
    """A posture that can be reached in time, by a move without collision with itself."""
    for _ in range(_POSTURES):
        wanted = _limited(before, _asked(draw, passage, hanging), reach)
        steps = before + np.minimum(np.arange(_STEPS) / 12.0, 1.0)[:, None] * (wanted - before)
        if check.clear(_walking(_STEPS), steps).all():
            return wanted
    return None


def _asked(draw: Draw, passage: Passage, hanging: Floats) -> Floats:
    """A random posture of the kind that the passage asks for."""
    asks, posture = passage.asks, hanging.copy()
    posture[DRAWN] += [draw.between(_LITTLE) for _ in DRAWN]
    posture[_ABDUCTIONS] += [draw.between(_AWAY), draw.between(_AWAY)]
    if asks in (levels.BEND, levels.BEND_ARMS):
        posture[_BEND] = draw.between(_BENT)
    if asks == levels.BEND_TWIST:
        posture[_BEND] = draw.between(_LEANING)
    if asks in (levels.TWIST, levels.TWIST_ARMS, levels.BEND_TWIST):
        posture[_TWIST] = passage.side * draw.between(_TWISTED)
    if asks in _ARMS:
        posture[LEFT], posture[RIGHT] = _arm(draw, _ARMS[asks]), _arm(draw, _ARMS[asks])
    near, other = (LEFT, RIGHT) if passage.side > 0 else (RIGHT, LEFT)
    if asks == levels.TWIST:
        posture[near], posture[other] = _arm(draw, (_BACK_ARM,)), _arm(draw, (_AHEAD_ARM,))
    if asks == levels.ONE_ARM:
        posture[near] = _arm(draw, _FREE_ARMS)
    return posture


def _arm(draw: Draw, kinds: tuple[ArmRanges, ...]) -> Floats:
    return np.array([draw.between(span) for span in draw.one_of(kinds)])


def _drifted(draw: Draw, held: Floats, hanging: Floats, check: SelfClearance, reach: Floats) -> Floats:
    """The posture at the end of a passage: a little further on in what differs from hanging, if there is room."""
    for _ in range(_DRIFTS):
        drift = np.zeros(LOCAL)
        drift[DRAWN] = [draw.between(_DRIFT) for _ in DRAWN]
        moved = _limited(held, held + np.where(np.abs(held - hanging) > 0.2, drift, 0.0), reach)
        if check.clear(_walking(_STEPS), np.tile(moved, (_STEPS, 1))).all():
            return moved
    return held


def _limited(before: Floats, wanted: Floats, reach: Floats) -> Floats:
    """As far towards the wanted posture as limits and reach allow, group by group; whole milliradians."""
    posture = wanted.copy()
    for columns, group, most in zip((WAIST, LEFT, RIGHT), _MOVED, reach, strict=True):
        posture[columns] = clamp(group, posture[columns])
        move = posture[columns] - before[columns]
        posture[columns] = before[columns] + move * min(1.0, 0.99 * most / max(float(np.linalg.norm(move)), 1e-9))
    return np.round(followed(posture), GRAIN)


def _is_clear(motion: UpperBodyMotion, check: SelfClearance) -> bool:
    """Whether the motion never runs into itself."""
    way = np.arange(motion.way[0], motion.way[-1], _TRANSITION_STEP)
    return bool(check.clear(_walking(len(way)), motion.at(way)).all())


def _walking(count: int) -> Floats:
    """Root states (count, 7) of a walk, in phases that soon have been all over the stride."""
    roots = np.zeros((count, 7))
    roots[:, 3], roots[:, 6] = WALK_SPEED, 0.37 * np.arange(count)
    return roots
