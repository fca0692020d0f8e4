"""A course: a scene that is feasible by construction, with the motion that proves it."""

import hashlib
import json
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.body_rows import BodyRows
from elbowroom.experiment.gauntlet.certificate import Certificate, certify
from elbowroom.experiment.gauntlet.draw import GRAIN, Draw
from elbowroom.experiment.gauntlet.levels import TWIST, Level, level_of
from elbowroom.experiment.gauntlet.line import CourseLine, LineTurn
from elbowroom.experiment.gauntlet.motion import DRAWN, Passage, draw_motion
from elbowroom.experiment.gauntlet.names import LARGEST_SEED
from elbowroom.experiment.gauntlet.placing import PlacedBox, fill_passage, passage_surroundings
from elbowroom.experiment.gauntlet.self_clearance import SelfClearance
from elbowroom.experiment.gauntlet.speeds import HumanSpeeds
from elbowroom.experiment.gauntlet.sweep import SweptBody
from elbowroom.world.scene import Scene
from elbowroom.world.scene_format import FORMAT, VERSION

_ATTEMPTS = 200
_LOOKS = 4  # every fourth sample of a certificate is held against the body itself
_SPEED = (0.8, 1.1)  # m/s
_START = 1.7  # metres from the start to the first passage
_TO_TWIST = 1.9  # metres of way before a doorway: the arms have to come down from wherever they are
_FINISH, _RUN_OUT = 1.3, 0.5  # metres from the last passage to the finish, and on
_WINDING = 0.6  # probability that a course of a level with turns is not straight
_TURNS = 0.75  # probability of a turn between two passages of such a course
_SHARPEST = 6.0  # metres, the least radius of a turn
_GROUND = 2.5  # metres of ground around everything
_TIME, _PACE = 30.0, 0.5  # seconds that a user has for any course, and metres per second beyond
_TITLES = {1: "roomy", 2: "easy", 3: "winding", 4: "narrow", 5: "hardly any room"}


class NoCourseError(InputError):
    """A seed gives no course to a body."""


@dataclass(frozen=True, eq=False)
class Course:
    """One random course."""

    level: int
    seed: int
    scene: Scene
    line: CourseLine
    passages: tuple[Passage, ...]
    groups: tuple[tuple[int, ...], ...]  # indices of the scene's boxes that belong to each passage
    certificate: Certificate
    fingerprint: str  # SHA-256 of all that was drawn
    limit: float  # seconds that a user has

    @property
    def name(self) -> str:
        """How the course is called everywhere."""
        return self.scene.name


@dataclass(frozen=True, eq=False)
class CourseMaker:
    """Makes courses for one humanoid; open it once, it costs some milliseconds."""

    body: SweptBody
    check: SelfClearance
    speeds: HumanSpeeds

    @classmethod
    def of(cls, humanoid: Humanoid) -> "CourseMaker":
        """The maker of courses that this humanoid fits through."""
        return cls(SweptBody(humanoid), SelfClearance(humanoid), HumanSpeeds())

    def course(self, level: int, seed: int) -> Course:
        """The course of this level and seed, the same whenever and wherever it is asked for.

        Raises `InputError` if there is no such level or seed, `NoCourseError` where this body gets none.
        """
        settings = level_of(level)
        settings = replace(settings, margin=round(min(self.body.scale, 1.0) * settings.margin, GRAIN))
        if not 0 <= seed <= LARGEST_SEED:
            raise InputError(f"seed: {seed} is not a whole number from 0 to {LARGEST_SEED}")
        for attempt in range(_ATTEMPTS):
            course = self._attempt(settings, seed, attempt)
            if course is not None:
                return course
        raise NoCourseError(f"seed: {seed} gives no course of level {level} in {_ATTEMPTS} attempts; take another")

    def _attempt(self, level: Level, seed: int, attempt: int) -> Course | None:
        winding = level.turn > 0.0 and Draw(level.number, seed).chance(_WINDING)  # the same in every attempt
        draw = Draw(level.number, seed, attempt)
        passages = _passages(draw, level, winding)
        line = _line(draw, passages, level.turn if winding else 0.0)
        motion = draw_motion(draw, passages, self.check, self.speeds)
        if motion is None:
            return None
        certificate = certify(line, motion, draw.between(_SPEED), level.margin)
        if not self._is_clear_of_itself(certificate):
            return None
        swept, stances = self.body.certificate(certificate, line), self.body.stances(line)
        groups: list[list[PlacedBox]] = []
        for passage in passages:
            around = passage_surroundings(self.body, line, swept, stances, passage, level.margin)
            group = fill_passage(draw, level, passage, around)
            if group is None:
                return None
            groups.append(group)
        if not _all_clear(groups, swept, level.margin):
            return None
        document = _document(level, seed, line, passages, groups)
        drawn = [document, motion.way.tolist(), np.round(motion.postures[:, DRAWN], GRAIN).tolist(), certificate.speed]
        return Course(
            level=level.number,
            seed=seed,
            scene=Scene.from_dict(document, document["name"]),
            line=line,
            passages=passages,
            groups=_indices(groups),
            certificate=certificate,
            fingerprint=hashlib.sha256(json.dumps(drawn, sort_keys=True).encode()).hexdigest(),
            limit=_TIME + line.length / _PACE,
        )

    def _is_clear_of_itself(self, certificate: Certificate) -> bool:
        """Whether the body keeps off itself in the very strides of a certificate; a motion is drawn before they are."""
        return bool(self.check.clear(certificate.roots[::_LOOKS], certificate.uppers[::_LOOKS]).all())


@lru_cache(maxsize=1)
def _stock_maker() -> CourseMaker:
    return CourseMaker.of(Humanoid.default())


def make_course(level: int, seed: int) -> Course:
    """The course of this level (1 to 5) and seed for the stock avatar; raises `InputError` if there is none."""
    return _stock_maker().course(level, seed)


def _passages(draw: Draw, level: Level, winding: bool) -> tuple[Passage, ...]:
    """Where the body has to be held, and how; doorways are for straight lines, where nobody comes askew."""
    kinds = tuple(asks for asks in level.asks if not (winding and asks == TWIST))
    count = draw.whole(*level.passages)
    places = list(range(count))
    long = {places.pop(draw.whole(0, len(places) - 1)) for _ in range(level.long_passages)}
    sure = draw.one_of(places)
    passages: list[Passage] = []
    end = 0.0
    for i in range(count):
        asks, gap = draw.one_of(kinds), _START if i == 0 else draw.between(level.gap)
        if i == sure and level.surely is not None:
            asks = level.surely
        begin = round(end + (max(gap, _TO_TWIST) if asks == TWIST else gap), GRAIN)
        end = round(begin + draw.between(level.long_hold if i in long else level.hold), GRAIN)
        passages.append(Passage(begin, end, asks, i in long, draw.sign()))
    return tuple(passages)


def _line(draw: Draw, passages: tuple[Passage, ...], sharpest: float) -> CourseLine:
    """A line with turns between the passages; through short passages it goes on turning."""
    turns: list[LineTurn] = []
    for before, after in pairwise(passages):
        begin = before.end if before.long else before.middle
        end = after.begin if after.long else after.middle
        most = min(sharpest, (end - begin) / (1.5 * _SHARPEST))
        if sharpest > 0.0 and draw.chance(_TURNS):
            turns.append(LineTurn(begin, end, round(draw.sign() * draw.between((0.4 * most, most)), GRAIN)))
    return CourseLine(round(passages[-1].end + _FINISH + _RUN_OUT, GRAIN), tuple(turns))


def _all_clear(groups: list[list[PlacedBox]], swept: BodyRows, margin: float) -> bool:
    """Whether the certificate keeps its margin from all obstacles on the whole way."""
    return all(swept.gap(obstacle.row()) >= margin for group in groups for obstacle in group)


def _indices(groups: list[list[PlacedBox]]) -> tuple[tuple[int, ...], ...]:
    ends = np.cumsum([0, *(len(group) for group in groups)])
    return tuple(tuple(range(first, last)) for first, last in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))


def _document(
    level: Level, seed: int, line: CourseLine, passages: tuple[Passage, ...], groups: list[list[PlacedBox]]
) -> dict[str, Any]:
    """The course as a scene file's JSON."""
    finish = passages[-1].end + _FINISH
    obstacles = [obstacle for group in groups for obstacle in group]
    points = line.points(np.linspace(0.0, line.length, 50))
    low, high = points.min(axis=0) - _GROUND, points.max(axis=0) + _GROUND
    kinds = ", ".join(passage.asks + (" (long)" if passage.long else "") for passage in passages)
    return {
        "format": FORMAT,
        "version": VERSION,
        "name": f"gauntlet-{level.number}-{seed}",
        "title": f"Gauntlet, level {level.number} ({_TITLES[level.number]}), seed {seed}",
        "description": f"Feasible by construction with {level.margin * 100:.0f} cm of room: {kinds}.",
        "ground": {
            "size": [round(float(value), GRAIN) for value in high - low],
            "center": [round(float(value), GRAIN) for value in 0.5 * (low + high)],
        },
        "start": {"position": [0.0, 0.0], "heading": 0.0},
        "finish": {
            "position": [round(float(value), GRAIN) for value in line.points(finish)],
            "heading": round(float(line.heading(finish)), GRAIN),
            "width": 4.0,
        },
        "obstacles": [
            {
                "type": "box",
                "name": f"{i + 1}: {obstacle.name}",
                "center": list(obstacle.center),
                "size": list(obstacle.size),
                "euler": list(obstacle.turn),
            }
            for i, obstacle in enumerate(obstacles)
        ],
    }
