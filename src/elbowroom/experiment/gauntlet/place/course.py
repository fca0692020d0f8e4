"""A course in a place: a way that somebody of this body can walk, and furniture put beside it at random."""

import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.course import NoCourseError
from elbowroom.experiment.gauntlet.draw import GRAIN, Draw
from elbowroom.experiment.gauntlet.names import LARGEST_SEED
from elbowroom.experiment.gauntlet.place.furnished import MARGIN
from elbowroom.experiment.gauntlet.place.furniture import Furniture, furniture_of, made_up
from elbowroom.experiment.gauntlet.place.proof import ProvenWalk, keeps_clear, proven_walk
from elbowroom.geometry import quaternion
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import NoWayError, Place
from elbowroom.world.ground.making import walked_over
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Mesh, Shape
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.place_scene import place_scene
from elbowroom.world.places.reading import read_place
from elbowroom.world.places.scene_place import with_more
from elbowroom.world.scene import Gate, Scene

Floats = NDArray[np.float64]
Progress = Callable[[str, float], None]

_ATTEMPTS, _TRIES = 160, 60  # ways for a course, and places for a piece of furniture
_SHORTEST, _LONGEST = 3.0, 25.0  # metres of way
_LEVEL = 0.05  # metres: the way is on the floor at height 0
_FAR = 3.0  # metres from corner to corner, at most
_ASIDE, _GAP = (0.3, 1.6), 0.45  # metres from the way to the middle of a piece, and from its side to who walks, at most
_ENDS = 0.8  # metres at both ends of the way that stay as they are
_SAMPLE, _ROOM = 0.15, 0.05  # metres: between points of a piece that are looked at, and the room that each has to have
_TIME, _PACE = 30.0, 0.4  # seconds that a user has for any course; m/s beyond
_SEED = 30_511  # of what is drawn here


@dataclass(frozen=True, eq=False)
class PlaceCourse:
    """One course in a place."""

    seed: int
    scene: Scene
    goal: Place
    corners: Floats  # (m, 2) of the way that is proven
    pieces: tuple[str, ...]  # what was put beside it
    fingerprint: str  # SHA-256 of all that was drawn
    limit: float  # seconds that a user has


@dataclass(frozen=True, eq=False)
class PlaceCourseMaker:
    """Makes courses in one place for one humanoid; opening it takes as long as opening the place."""

    humanoid: Humanoid
    fixed: Scene  # the place without what can be moved
    own: tuple[Furniture, ...]  # what can be moved
    count: int  # pieces that are put beside each way

    @classmethod
    def open(
        cls,
        humanoid: Humanoid,
        path: Path,
        options: PlaceOptions,
        count: int,
        progress: Progress = lambda _what, _share: None,
    ) -> "PlaceCourseMaker":
        """Read a place; raises `InputError`."""
        whole = read_place(path, options, progress)
        found = place_scene(whole, progress).place
        assert found is not None
        assert found.options.ground is not None
        pieces, rest = furniture_of(whole, found.options.ground)
        fixed = place_scene(replace(rest, options=found.options))
        assert fixed.place is not None
        return cls(humanoid, replace(fixed, place=replace(fixed.place, place=None)), pieces, count)

    def course(self, seed: int) -> PlaceCourse:
        """The course of this seed; raises `NoCourseError` where there is none."""
        if not 0 <= seed <= LARGEST_SEED:
            raise InputError(f"seed: {seed} is not a whole number from 0 to {LARGEST_SEED}")
        for attempt in range(_ATTEMPTS):
            course = self._attempt(seed, Draw(_SEED, seed, attempt))
            if course is not None:
                return course
        raise NoCourseError(f"seed: {seed} gives no course in {self.fixed.title} in {_ATTEMPTS} attempts; take another")

    def _attempt(self, seed: int, draw: Draw) -> PlaceCourse | None:
        corners = self._corners(draw)
        if corners is None:
            return None
        walk = proven_walk(self.humanoid, corners)
        if not keeps_clear(walk, self._standing, MARGIN):
            return None
        placed = self._furnished(draw, corners, walk)
        return None if not placed else self._built(seed, corners, placed)

    def _corners(self, draw: Draw) -> Floats | None:
        """A way (m, 2) between two places on the level floor."""
        places = self._places
        begin, goal = (tuple(places[draw.whole(0, len(places) - 1)].tolist()) for _ in range(2))
        try:
            way = self._navigator.find(begin, goal)
        except NoWayError:
            return None
        corners = way.corners(begin, _FAR)
        length = float(np.hypot(*np.diff(corners[:, [0, 2]], axis=0).T).sum()) if len(corners) > 1 else 0.0
        level = float(np.abs(corners[:, 1]).max()) <= _LEVEL and not way.climbs
        return np.round(corners[:, [0, 2]], GRAIN) if level and _SHORTEST <= length <= _LONGEST else None

    def _furnished(self, draw: Draw, corners: Floats, walk: ProvenWalk) -> list[tuple[Furniture, Floats, float]]:
        """Pieces with the middle (2,) and the turn of each, beside a way; fewer where there is no room for more."""
        placed, left = list[tuple[Furniture, Floats, float]](), list(self.own)
        for _ in range(self.count):
            piece = left.pop(draw.whole(0, len(left) - 1)) if left else made_up(draw)
            for _ in range(_TRIES):
                middle, turn = self._somewhere(draw, corners, walk), draw.between((-math.pi, math.pi))
                if self._fits(piece, middle, turn, walk, placed):
                    placed.append((piece, middle, turn))
                    break
        return placed

    def _somewhere(self, draw: Draw, corners: Floats, walk: ProvenWalk) -> Floats:
        """A place (2,) beside the way."""
        lengths = np.hypot(*np.diff(corners, axis=0).T)
        along = draw.between((min(_ENDS, 0.4 * walk.length), max(walk.length - _ENDS, 0.6 * walk.length)))
        leg = min(int(np.searchsorted(np.cumsum(lengths), along)), len(lengths) - 1)
        step = (corners[leg + 1] - corners[leg]) / max(float(lengths[leg]), 1e-9)
        here = corners[leg] + (along - float(lengths[:leg].sum())) * step
        found: Floats = np.round(here + draw.sign() * draw.between(_ASIDE) * np.array([step[1], -step[0]]), GRAIN)
        return found

    def _fits(
        self,
        piece: Furniture,
        middle: Floats,
        turn: float,
        walk: ProvenWalk,
        placed: Sequence[tuple[Furniture, Floats, float]],
    ) -> bool:
        """Whether a piece stands on the floor, apart from the others, near the way and out of it."""
        reach = float(np.hypot(piece.half[0], piece.half[2]))
        for other, at, _ in placed:
            if float(np.hypot(*(at - middle))) < 0.8 * (reach + float(np.hypot(other.half[0], other.half[2]))):
                return False
        gap = walk.rows.gap(_box_row(piece, middle, turn))
        return MARGIN <= gap <= _GAP and self._on_floor(piece, middle, turn)

    def _on_floor(self, piece: Furniture, middle: Floats, turn: float) -> bool:
        room = self._navigator.room()
        x, z = (np.linspace(-half, half, max(2, math.ceil(2.0 * half / _SAMPLE) + 1)) for half in piece.half[[0, 2]])
        for dx in x.tolist():
            for dz in z.tolist():
                px = middle[0] + dx * math.cos(turn) + dz * math.sin(turn)
                pz = middle[1] - dx * math.sin(turn) + dz * math.cos(turn)
                at = room.next_to(px, pz, 0.0)
                if at is None or room.room[at] < _ROOM or abs(float(room.surfaces.heights[at])) > _LEVEL:
                    return False
        return True

    def _built(self, seed: int, corners: Floats, placed: list[tuple[Furniture, Floats, float]]) -> PlaceCourse:
        placed = sorted(placed, key=lambda one: not isinstance(one[0].shape, Mesh))  # the place's own first
        centers = np.array([[at[0], piece.height, at[1]] for piece, at, _ in placed])
        own = np.array([isinstance(piece.shape, Mesh) for piece, _, _ in placed])
        turned = np.array([quaternion.about_axis(1, turn) for _, _, turn in placed])
        shapes = tuple(_turned(piece.shape, turn) for (piece, _, _), turn in zip(placed, turned, strict=True))
        turns = np.where(own[:, None], [0.0, 0.0, 0.0, 1.0], turned)
        names = tuple(f"{number}: {piece.name}"[:60] for number, (piece, _, _) in enumerate(placed, 1))
        fixed, place, more = self.fixed, self.fixed.place, Obstacles(shapes, centers, turns, names)
        assert place is not None
        heading, last = (math.atan2(*(corners[k + 1] - corners[k])) for k in (0, len(corners) - 2))
        (x, z), (goal_x, goal_z) = corners[0].tolist(), corners[-1].tolist()
        drawn = b"".join(values.astype("<f8").tobytes() for values in (corners, centers, turned))
        length = float(np.hypot(*np.diff(corners, axis=0).T).sum())
        return PlaceCourse(
            seed=seed,
            scene=replace(
                fixed,
                name=f"{fixed.name}-{seed}"[:60],
                title=f"{fixed.title}, furniture moved by seed {seed}",
                start=RootState(x=x, z=z, heading=heading),
                finish=Gate((goal_x, goal_z), last),
                obstacles=walked_over(with_more(fixed.obstacles, more), place.floor),
                place=replace(place, parts=place.parts + int(own.sum())),
            ),
            goal=(goal_x, 0.0, goal_z),
            corners=corners,
            pieces=names,
            fingerprint=hashlib.sha256(place.sha256.encode() + drawn).hexdigest(),
            limit=_TIME + length / _PACE,
        )

    @cached_property
    def _navigator(self) -> Navigator:
        return Navigator(self.humanoid, self.fixed)

    @cached_property
    def _standing(self) -> Obstacles:
        """What stands without the floor."""
        return replace(self.fixed.obstacles, ground=0.02)

    @cached_property
    def _places(self) -> Floats:
        """The places (N, 3) on the level floor that can be reached from where one begins."""
        start = self.fixed.start
        found = self._navigator.room().places[self._navigator.reachable((start.x, start.height, start.z))]
        level = found[np.abs(found[:, 1]) <= _LEVEL]
        if not len(level):
            raise InputError(f"{self.fixed.title}: nobody can walk on its floor from where one begins")
        return level


def _turned(shape: Shape, turn: Floats) -> Shape:
    """A shape; the triangles of what a place has are turned here: its parts stand as they are written down."""
    if not isinstance(shape, Mesh):
        return shape
    return Mesh(quaternion.rotate(turn, shape.vertices).astype(np.float32).astype(np.float64), shape.faces)


def _box_row(piece: Furniture, middle: Floats, turn: float) -> Floats:
    """The box of a piece as `BodyRows.gap` takes it (15,)."""
    cosine, sine = math.cos(turn), math.sin(turn)
    to_box = np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
    return np.concatenate([[middle[0], piece.height, middle[1]], to_box.ravel(), piece.half])
