"""Obstacles are pushed towards the line until they are as near to the certificate motion as its margin allows."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.experiment.gauntlet.body_rows import BodyRows, Pieces, least_gap
from elbowroom.experiment.gauntlet.draw import GRAIN, Draw
from elbowroom.experiment.gauntlet.levels import Level
from elbowroom.experiment.gauntlet.line import CourseLine, Spot
from elbowroom.experiment.gauntlet.motion import Passage
from elbowroom.experiment.gauntlet.obstacles import Proposal, propose
from elbowroom.experiment.gauntlet.sweep import SweptBody
from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]
Vector = tuple[float, float, float]

_REACH = 1.6  # metres of way before and after a passage that its obstacles may matter to
_BESIDE = 0.6  # metres of way before and after a passage where the natural walk may touch
_SIGHT = 3.4  # metres that walkers look ahead: stances there belong to a place before
_ROUGHLY = 7  # of so many rows one is looked at first
_ROUGH = 0.08  # metres by which that may lead too far
_LEG_ROOM = 0.03  # metres that obstacles keep from the stances
_TOUCHES = 0.005  # metres that the natural walk must get into an obstacle
_PROPOSALS = 60  # for one passage
_PUSHES = 30
_NEAR = 1e-3  # metres: pushing ends at such a slack, which rounding may use up
_ROUNDING = 1e-9  # metres: more than a sum of distances is wrong by
_HIPS = 0.9  # metres above the ground of a body of usual size: what comes from above goes little lower
_PAST = 0.25  # metres: what is pushed this far past the line has missed the body


@dataclass(frozen=True)
class PlacedBox:
    """An obstacle in its place: whole millimetres and milliradians."""

    name: str
    center: Vector
    turn: Vector  # about X, Y, Z in the order "YXZ", radians
    size: Vector

    def row(self) -> Floats:
        """The obstacle as a row (15,), for `BodyRows.gap`."""
        return np.array([*self.center, *_to_box(self.turn), *(0.5 * side for side in self.size)])


def _to_box(turn: Vector) -> tuple[float, ...]:
    """The rotation matrix (9,) from the world into a box turned by angles about X, Y, Z in the order "YXZ", by rows."""
    (sx, sy, sz), (cx, cy, cz) = map(math.sin, turn), map(math.cos, turn)
    return (
        cy * cz + sy * sx * sz, cx * sz, cy * sx * sz - sy * cz,
        sy * sx * cz - cy * sz, cx * cz, sy * sz + cy * sx * cz,
        sy * cx, -sx, cy * cx,
    )  # fmt: skip


@by_reference
class Keepout(NamedTuple):
    """What a pushed box has to keep away from."""

    certificate: Pieces
    stances: Pieces
    margin: float  # metres from the certificate's rows
    leg_room: float  # metres from the stances

    def free(self, box: Floats) -> bool:
        """Whether a box (15,) keeps away from it all."""
        far = least_gap(self.certificate, box, np.inf) >= self.margin
        return far and least_gap(self.stances, box, np.inf) >= self.leg_room


@exact_kernel
def pushed(keepout: Keepout, box: Floats, push: Floats, done: float, most: float) -> float:
    """How far in all a box can be pushed, from `done` metres on; 0 if not at all, or farther than `most`.

    A box that moves as far as it has slack cannot touch, for the slack shrinks at most as fast as the box moves.
    """
    moved, margin, leg_room = box.copy(), keepout.margin, keepout.leg_room
    for _ in range(_PUSHES):
        for k in range(3):
            moved[k] = box[k] + done * push[k]
        slack = least_gap(keepout.certificate, moved, np.inf) - margin
        slack = min(slack, least_gap(keepout.stances, moved, slack + leg_room + _ROUNDING) - leg_room) - _NEAR
        if slack < _NEAR:
            break
        done += slack
        if done > most:
            return 0.0
    return done


@dataclass(frozen=True, eq=False)
class PassageSurroundings:
    """What the obstacles of one passage have to mind."""

    spot: Spot  # the middle of the passage
    rough: Keepout  # some of the rows of `fine`: finds quickly what will never do
    fine: Keepout
    natural: list[Pieces]  # the natural walk, once for each of eight phases in which it may come
    scale: float  # of the body, for obstacles of its size

    def touched(self, box: Floats) -> bool:
        """Whether every one of the natural walks runs into the box."""
        deep = -_TOUCHES * min(self.scale, 1.0)
        return all(least_gap(walk, box, 0.0) < deep for walk in self.natural)


def passage_surroundings(
    body: SweptBody, line: CourseLine, certificate: BodyRows, stances: BodyRows, passage: Passage, margin: float
) -> PassageSurroundings:
    """What matters near a passage."""
    first, last = passage.begin - _REACH, passage.end + _REACH
    leg_room = _LEG_ROOM * min(body.scale, 1.0)
    certificate, stances = certificate.between(first, last), stances.between(first - _SIGHT, last)
    fine = Keepout(certificate.pieces, stances.pieces, margin, leg_room)
    rough = Keepout(certificate.every(_ROUGHLY).pieces, stances.every(3).pieces, margin, leg_room)
    natural = body.natural_walks(line, max(0.0, passage.begin - _BESIDE), passage.end + _BESIDE)
    return PassageSurroundings(line.spot(passage.middle), rough, fine, [walk.pieces for walk in natural], body.scale)


def fill_passage(draw: Draw, level: Level, passage: Passage, around: PassageSurroundings) -> list[PlacedBox] | None:
    """Random obstacles for a passage, each unlike the others; None if not enough were found."""
    wanted = draw.whole(*level.obstacles)
    placed: list[PlacedBox] = []
    found = 0
    for _ in range(_PROPOSALS):
        group = [
            proposal.scaled(around.scale, passage.long and found == 0)
            for proposal in propose(draw, passage, first=found == 0)
        ]
        new = [_pushed(proposal, around) for proposal in group if not _is_known(proposal.name, placed)]
        whole = [obstacle for obstacle in new if obstacle is not None and not _overlaps(obstacle, placed)]
        if len(whole) == len(group):
            placed += whole
            found += 1
            if found == wanted:
                return placed
    return placed if found >= level.obstacles[0] else None


def _is_known(name: str, placed: list[PlacedBox]) -> bool:
    return any(obstacle.name == name for obstacle in placed)


def _overlaps(new: PlacedBox, placed: list[PlacedBox]) -> bool:
    """Whether an obstacle is half inside another: the middle of one in the other."""
    box = new.row()
    others = [obstacle.row() for obstacle in placed]
    return any(_holds(box, other[:3]) or _holds(other, box[:3]) for other in others)


def _holds(box: Floats, point: Floats) -> bool:
    inside = np.abs(box[3:12].reshape(3, 3) @ (point - box[:3])) <= box[12:]
    return bool(inside.all())


def _pushed(proposal: Proposal, around: PassageSurroundings) -> PlacedBox | None:
    """The obstacle where it can be pushed no further; None if it touches the certificate or misses the natural walk."""
    heading = round(around.spot.heading, GRAIN)
    turn = (proposal.turn[0], round(proposal.turn[1] + heading, GRAIN), proposal.turn[2])
    end = [start + way for start, way in zip(proposal.begin, proposal.push, strict=True)]
    box = PlacedBox(proposal.name, around.spot.world(*proposal.begin), turn, proposal.size).row()
    begin = box[:3].copy()
    push = np.array(around.spot.world(*end)) - begin
    most = _way_to_line(proposal, around.scale)
    farthest = pushed(around.rough, box, push, 0.0, most)
    if farthest <= 0.0 or not around.touched(_moved(box, farthest * push)):
        return None
    done = pushed(around.fine, box, push, max(0.0, farthest - _ROUGH), most)
    if done <= 0.0:
        return None
    box[:3] = np.round(begin + done * push, GRAIN)
    if not around.fine.free(box) or not around.touched(box):
        return None
    x, y, z = box[:3].tolist()
    return PlacedBox(proposal.name, (x, y, z), turn, proposal.size)


def _moved(box: Floats, by: Floats) -> Floats:
    moved = box.copy()
    moved[:3] += by
    return moved


def _way_to_line(proposal: Proposal, scale: float) -> float:
    """How far a proposal can be pushed until it has passed where the body is, metres."""
    across, down = abs(proposal.push[0]), -proposal.push[1]
    if across > down:
        return (abs(proposal.begin[0]) + _PAST) / across
    return (proposal.begin[1] - scale * _HIPS + _PAST) / down
