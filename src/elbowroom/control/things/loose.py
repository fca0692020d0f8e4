"""Obstacles that a hand pushes over the ground while somebody walks there.

What was taken in hand once is loose until the walk is put back to its start. It follows the hand at a bounded speed,
stays upright over the scene's ground, and stops before the body that is shown: so who stands still is never touched. It
stops before walls, what moves by itself and other things too (`thing_room.py`), or goes along them.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.things.thing_room import ThingRoom
from elbowroom.errors import InputError
from elbowroom.geometry import quaternion
from elbowroom.planning.stillness import is_still
from elbowroom.world.ground.ground import STEEPEST, STEP
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Shape, Sphere, extents_of
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Place = tuple[float, float]  # x and z, metres

FASTEST = 1.5  # m/s
ACCELERATION = 6.0  # m/s²
WIDEST = 2.5  # metres across: what is larger stays where it is
FORESEEN = 0.6  # seconds for which what moves is taken to go on as it does
_STILL = 1e-3  # m/s and m: slower, nearer is there
_SHARES = (1.0, 0.5, 0.25)  # of a step, where all of it would lead too near to the body or into something
_UPRIGHT = 1e-6  # by how much the Y axis of an upright thing may be off
_SHAPES = (Box, Sphere, Capsule, Cylinder)


@dataclass(frozen=True)
class Hand:
    """What is in hand."""

    number: int  # among the standing obstacles of the scene as it was loaded
    place: Place  # where to


@dataclass(frozen=True, eq=False)
class Thing:
    """One that is loose."""

    name: str
    shape: Shape
    yaw: float  # radians about Y
    center: Floats  # (3,) metres
    velocity: Floats  # (2,) m/s along x and z

    @property
    def place(self) -> Place:
        """Where its middle is over the ground."""
        return float(self.center[0]), float(self.center[2])

    @property
    def top(self) -> float:
        """How high it reaches, metres."""
        return float(self.center[1] + extents_of(self.shape)[1])

    @property
    def moves(self) -> bool:
        """Whether it moves."""
        return not is_still(self.velocity)

    def track(self, times: Floats, places: Floats) -> Track:
        """It at places (K, 2) at times (K,)."""
        centers = np.column_stack([places[:, 0], np.full(len(times), self.center[1]), places[:, 1]])
        return Track(self.name, self.shape, times, centers, np.full(len(times), self.yaw), Repeat.ONCE)


def thing_of(scene: Scene, number: int) -> Thing:
    """A standing obstacle as a thing to push; raises `InputError` where it is none, or cannot be pushed."""
    if scene.place is not None or not 0 <= number < len(scene.obstacles.shapes):
        raise InputError(f"obstacle {number} of scene {scene.name}: there is nothing that can be pushed by this number")
    obstacles = scene.obstacles
    name, shape, turn = obstacles.standing_names[number], obstacles.shapes[number], obstacles.rotations[number]
    if not _can_be_pushed(shape, obstacles.centers[number], turn):
        raise InputError(
            f"obstacle {name} of scene {scene.name}: only what is upright, small and no ground can be pushed"
        )
    matrix = quaternion.to_matrix(turn)
    yaw = math.atan2(matrix[0, 2], matrix[2, 2])
    return Thing(name, shape, yaw, obstacles.centers[number].copy(), np.zeros(2))


def pushable(scene: Scene) -> tuple[int, ...]:
    """The numbers of all standing obstacles that can be pushed; none in the model of a place."""
    if scene.place is not None:
        return ()
    obstacles = scene.obstacles
    every = enumerate(zip(obstacles.shapes, obstacles.centers, obstacles.rotations, strict=True))
    return tuple(number for number, told in every if _can_be_pushed(*told))


def _can_be_pushed(shape: Shape, center: Floats, turn: Floats) -> bool:
    """Whether a shape at a place is small, stands upright when it is turned so, and is nothing that one stands on."""
    half = extents_of(shape)
    if not isinstance(shape, _SHAPES) or 2.0 * float(np.hypot(half[0], half[2])) > WIDEST:
        return False
    dome = half[0] * (1.0 - math.cos(STEEPEST)) if isinstance(shape, Sphere | Capsule) else 0.0
    lowest = float(center[1] + half[1] - dome)  # of what is level enough on top to be ground
    return lowest > STEP and quaternion.to_matrix(turn)[1, 1] >= 1.0 - _UPRIGHT


def scene_without(scene: Scene, numbers: frozenset[int]) -> Scene:
    """The scene without some of its standing obstacles."""
    every = scene.obstacles
    kept = [i for i in range(len(every.shapes)) if i not in numbers]
    standing = Obstacles(
        tuple(every.shapes[i] for i in kept), every.centers[kept], every.rotations[kept],
        tuple(every.standing_names[i] for i in kept), every.moving, every.ground,
    )  # fmt: skip
    return replace(scene, obstacles=standing)


def at_rest(things: Iterable[Thing], time: float) -> Moving:
    """Things as they stand from `time` on."""
    times = np.array([time, time + 1.0])
    return Moving(tuple(thing.track(times, np.array([thing.place] * 2)) for thing in things))


def _slower(velocity: Floats) -> Iterator[Floats]:
    """A velocity, slower ones, those along x and z alone, and at last none."""
    for share in _SHARES:
        yield share * velocity
    yield np.array([velocity[0], 0.0])
    yield np.array([0.0, velocity[1]])
    yield np.zeros(2)


class Loose:
    """The things that are loose in a scene, and the hand."""

    def __init__(self, scene: Scene) -> None:
        """None is loose yet."""
        self._scene = scene
        self._things: dict[int, Thing] = {}
        self._still: tuple[frozenset[int], Scene] | None = None  # what was loose at the last `scene()`, and it
        self.hand: Hand | None = None

    def __len__(self) -> int:
        return len(self._things)

    @property
    def things(self) -> dict[int, Thing]:
        """What is loose, by number."""
        return dict(self._things)

    @property
    def moves(self) -> bool:
        """Whether any of it moves."""
        return any(thing.moves for thing in self._things.values())

    def take(self, hand: Hand, is_underfoot: Callable[[Thing], bool]) -> bool:
        """Push a thing towards a place; whether it has become loose by that. Raises `InputError`.

        What `is_underfoot` cannot be pushed.
        """
        if not all(map(math.isfinite, hand.place)):
            raise InputError(f"push: {hand.place} is no place on the ground")
        fresh = hand.number not in self._things
        if fresh:
            thing = thing_of(self._scene, hand.number)
            if is_underfoot(thing):
                raise InputError(f"obstacle {thing.name} of scene {self._scene.name}: the avatar stands on it")
            self._things[hand.number] = thing
        self.hand = replace(hand, place=self._inside(hand.place))
        return fresh

    def let_go(self) -> None:
        """Nothing is in hand; what moves comes to a stand."""
        self.hand = None

    def scene(self) -> Scene:
        """What stands still."""
        numbers = frozenset(self._things)
        if self._still is None or self._still[0] != numbers:
            self._still = numbers, scene_without(self._scene, numbers)
        return self._still[1]

    def surroundings(self, time: float) -> Scene:
        """The scene as it is at a time: the things come after all else that moves, and stand where they are."""
        if not self._things:
            return self._scene
        standing = self.scene()
        moving = standing.obstacles.moving + self.at_rest(time)
        return replace(standing, obstacles=replace(standing.obstacles, moving=moving))

    def at_rest(self, time: float) -> Moving:
        """The things where they are, as if they stood from `time` on."""
        return at_rest(self._things.values(), time)

    def advance(self, time: float, dt: float, leaves_alone: Callable[[Moving, float], bool]) -> Moving:
        """Go on by `dt` seconds from `time`; how the things move meanwhile.

        `leaves_alone` says whether one that moves so, along so many metres, stays away from the body that is shown.
        """
        tracks, times = [], np.array([time, time + dt])
        for number, thing in self._things.items():
            wanted, here = self._wanted(number, thing, dt), np.array(thing.place)
            room = self._room(number, time + dt) if not is_still(wanted) else None
            for velocity in _slower(wanted):
                track = thing.track(times, np.array([here, here + dt * velocity]))
                way = dt * float(np.hypot(*velocity))
                if room is None or way <= 0.0 or (room.lets(track) and leaves_alone(Moving((track,)), way)):
                    break
            if thing.moves or not is_still(velocity):
                self._things[number] = replace(thing, center=track.centers[1].copy(), velocity=velocity)
            tracks.append(track)
        return Moving(tuple(tracks))

    def _room(self, number: int, time: float) -> ThingRoom:
        """What a thing must not enter."""
        others = {other: thing for other, thing in self._things.items() if other != number}
        return ThingRoom(self.scene().obstacles, at_rest(others.values(), time), time)

    def foreseen(self, now: float, time: float, clear: Callable[[Moving], bool]) -> Moving:
        """Where the things will be, as far as their motion `now` tells: on for a while, then they stand.

        `clear` says whether a track leaves the pose free in which a plan starts at `time`: where it does not, the thing
        is taken to wait until then.
        """
        tracks = []
        for thing in self._things.values():
            here = np.array(thing.place)
            there = here + FORESEEN * thing.velocity
            going = thing.track(np.array([now, now + FORESEEN]), np.array([here, there]))
            waits = time > now and not clear(Moving((going,)))
            tracks.append(thing.track(np.array([time, time + FORESEEN]), np.array([here, there])) if waits else going)
        return Moving(tuple(tracks))

    def _wanted(self, number: int, thing: Thing, dt: float) -> Floats:
        """Its next velocity: towards the hand, so that it can stop there, or to a stand."""
        wanted = np.zeros(2)
        if self.hand is not None and self.hand.number == number:
            way = np.array(self.hand.place) - thing.place
            length = float(np.hypot(*way))
            if length > _STILL:
                speed = min(FASTEST, math.sqrt(ACCELERATION * length), length / dt)
                wanted = way * (speed / length)
        change = wanted - thing.velocity
        most, size = ACCELERATION * dt, float(np.hypot(*change))
        found: Floats = wanted if size <= most else thing.velocity + change * (most / size)
        return found

    def _inside(self, place: Place) -> Place:
        """The nearest place over the scene's ground."""
        scene = self._scene
        x, z = (
            min(max(at, middle - 0.5 * size), middle + 0.5 * size)
            for at, middle, size in zip(place, scene.ground_center, scene.ground_size, strict=True)
        )
        return x, z
