"""Obstacles are pushed towards the line until they are as near to the certificate motion as its margin allows."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.gauntlet.body_rows import BodyRows
from elbowroom.experiment.gauntlet.draw import GRAIN, Draw
from elbowroom.experiment.gauntlet.levels import Level
from elbowroom.experiment.gauntlet.line import CourseLine
from elbowroom.experiment.gauntlet.motion import Passage
from elbowroom.experiment.gauntlet.obstacles import Proposal, propose
from elbowroom.experiment.gauntlet.sweep import SweptBody

Floats = NDArray[np.float64]

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
_HIPS = 0.9  # metres above the ground of a body of usual size: what comes from above goes little lower
_PAST = 0.25  # metres: what is pushed this far past the line has missed the body


@dataclass(frozen=True)
class Placed:
    """An obstacle in its place: whole millimetres and milliradians."""

    name: str
    center: tuple[float, float, float]
    turn: tuple[float, float, float]  # about X, Y, Z in the order "YXZ", radians
    size: tuple[float, float, float]

    def row(self) -> Floats:
        """The obstacle as a row (15,), for `BodyRows.gap`."""
        return np.concatenate([self.center, _to_box(self.turn).ravel(), 0.5 * np.array(self.size)])


def _to_box(turn: tuple[float, float, float]) -> Floats:
    """The rotation matrix (3, 3) from the world into a box turned by angles about X, Y, Z in the order "YXZ"."""
    (sx, sy, sz), (cx, cy, cz) = np.sin(turn).tolist(), np.cos(turn).tolist()
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    about_z = np.array([[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]])
    to_box: Floats = (about_y @ about_x @ about_z).T
    return to_box


class Keepout(NamedTuple):
    """What a pushed box has to keep away from."""

    certificate: BodyRows
    stances: BodyRows
    margin: float  # metres from the certificate's rows
    leg_room: float  # metres from the stances

    def slack(self, box: Floats) -> float:
        """How much nearer a box (15,) may come, metres."""
        return min(self.certificate.gap(box) - self.margin, self.stances.gap(box) - self.leg_room)

    def pushed(self, box: Floats, push: Floats, done: float, most: float) -> float | None:
        """How far in all the box can be pushed, from `done` metres on; None if not at all, or farther than `most`.

        A box that moves as far as it has slack cannot touch, for the slack shrinks at most as fast as the box moves.
        """
        begin = box[:3].copy()
        for _ in range(_PUSHES):
            box[:3] = begin + done * push
            slack = self.slack(box) - _NEAR
            if slack < _NEAR:
                break
            done += slack
            if done > most:
                break
        box[:3] = begin
        return None if done > most or done <= 0.0 else done


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What the obstacles of one passage have to mind."""

    line: CourseLine
    rough: Keepout  # some of the rows of `fine`: finds quickly what will never do
    fine: Keepout
    natural: list[BodyRows]  # the natural walk, once for each of eight phases in which it may come
    scale: float  # of the body, for obstacles of its size

    def touched(self, box: Floats) -> bool:
        """Whether every one of the natural walks runs into the box."""
        return all(rows.gap(box) < -_TOUCHES * min(self.scale, 1.0) for rows in self.natural)


def surroundings(
    body: SweptBody, line: CourseLine, certificate: BodyRows, stances: BodyRows, passage: Passage, margin: float
) -> Surroundings:
    """What matters near a passage."""
    first, last = passage.begin - _REACH, passage.end + _REACH
    leg_room = _LEG_ROOM * min(body.scale, 1.0)
    fine = Keepout(certificate.between(first, last), stances.between(first - _SIGHT, last), margin, leg_room)
    rough = Keepout(fine.certificate.every(_ROUGHLY), fine.stances.every(3), margin, leg_room)
    natural = body.natural_walks(line, max(0.0, passage.begin - _BESIDE), passage.end + _BESIDE)
    return Surroundings(line, rough, fine, natural, body.scale)


def fill_passage(draw: Draw, level: Level, passage: Passage, around: Surroundings) -> list[Placed] | None:
    """Random obstacles for a passage, each unlike the others; None if not enough were found."""
    wanted = draw.whole(*level.obstacles)
    placed: list[Placed] = []
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


def _is_known(name: str, placed: list[Placed]) -> bool:
    return any(obstacle.name == name for obstacle in placed)


def _overlaps(new: Placed, placed: list[Placed]) -> bool:
    """Whether an obstacle is half inside another: the middle of one in the other."""
    box = new.row()
    others = [obstacle.row() for obstacle in placed]
    return any(_holds(box, other[:3]) or _holds(other, box[:3]) for other in others)


def _holds(box: Floats, point: Floats) -> bool:
    inside = np.abs(box[3:12].reshape(3, 3) @ (point - box[:3])) <= box[12:]
    return bool(inside.all())


def _pushed(proposal: Proposal, around: Surroundings) -> Placed | None:
    """The obstacle where it can be pushed no further; None if it touches the certificate or misses the natural walk."""
    heading = round(float(around.line.heading(proposal.way)), GRAIN)
    turn = (proposal.turn[0], round(proposal.turn[1] + heading, GRAIN), proposal.turn[2])
    ends = np.stack([np.asarray(proposal.begin), np.add(proposal.begin, proposal.push)])
    begin, end = around.line.local(proposal.way, ends)
    push = end - begin
    box = Placed(proposal.name, (0.0, 0.0, 0.0), turn, proposal.size).row()
    box[:3] = begin
    most = _way_to_line(proposal, around.scale)
    farthest = around.rough.pushed(box, push, 0.0, most)
    if farthest is None or not around.touched(_moved(box, farthest * push)):
        return None
    done = around.fine.pushed(box, push, max(0.0, farthest - _ROUGH), most)
    if done is None:
        return None
    box[:3] = np.round(begin + done * push, GRAIN)
    if around.fine.slack(box) < 0.0 or not around.touched(box):
        return None
    x, y, z = box[:3].tolist()
    return Placed(proposal.name, (x, y, z), turn, proposal.size)


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
