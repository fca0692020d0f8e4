"""Where users steer and how: corridors with bends and slaloms built in code, stock scenes, courses; scripted hands."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.bench.settings import check_steered
from elbowroom.experiment.gauntlet.course import make_course
from elbowroom.geometry import quaternion
from elbowroom.planning.command import Command
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Gate, Scene

Floats = NDArray[np.float64]
Steer = Callable[[float, float, float], Command]  # seconds since the start, the avatar's place x, z

_BENDS = (30.0, -45.0, 60.0, -95.0, 80.0, -30.0)  # degrees, positive to the left
_STRETCH = 2.2  # metres between bends
_WALL = (0.1, 2.2)  # metres: thickness and height
_POSTS, _APART, _BESIDE = 6, 1.5, 0.2  # a slalom: posts, metres from one to the next, and beside the middle
_POST = 0.05  # metres, half the thickness
_PILLARS = (0.6, 1.2, 1.6)  # metres: the breadths of those that stand in the line
_DEPTH, _BETWEEN = 0.4, 4.0  # metres: their depth, and from one to the next
_TREADS, _RISE, _DEEP = 5, 0.17, 0.28  # a stair up and down again: treads, metres
_STAIR, _LANDING, _SILL = 2.0, 1.2, (7.5, 0.1, 0.1)  # where it begins, its landing; a sill's place, depth and height
_PAST = 0.45  # metres beside the middle at which a user means to pass a post
_LEAD = 0.9  # metres ahead on the route to where a user looks
_HAND, _FASTEST = 6.0, 3.5  # 1/s, rad/s: how a mouse is moved to where one means to look
_TREMBLES = ((0.02, 1.3), (0.008, 3.1))  # radians, Hz: a hand is never still
_ASKEW = (0.35, 1.0)  # x, z: from here a user comes to the doorway
_COURSE_SEED = 1013
_SPEED = 1.1  # m/s


class SteeredScene(NamedTuple):
    """One thing to measure."""

    name: str
    scene: Scene
    route: Floats  # (m, 2) where the user means to go, x and z
    hand: Callable[[Floats], Steer]  # makes a user for a route


def mouse_look(route: Floats) -> Steer:
    """W is held, and the mouse turned towards a point ahead on the route: each command is a little different."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route, axis=0).T))])
    marks = np.arange(0.0, along[-1], 0.05)
    points = np.stack([np.interp(marks, along, column) for column in route.T], axis=1)
    run_out = (route[-1] - route[-2]) / np.hypot(*(route[-1] - route[-2]))
    heading, last, reached = math.atan2(*(route[1] - route[0])), 0.0, 0

    def command(time: float, x: float, z: float) -> Command:
        nonlocal heading, last, reached
        near = points[reached : reached + 20]
        reached += int(np.argmin(np.hypot(near[:, 0] - x, near[:, 1] - z)))
        aim = marks[reached] + _LEAD
        goal = [np.interp(aim, along, column) for column in route.T] + max(aim - along[-1], 0.0) * run_out
        off = math.remainder(math.atan2(goal[0] - x, goal[1] - z) - heading, math.tau)
        heading += max(-_FASTEST, min(_FASTEST, _HAND * off)) * (time - last)
        last = time
        trembling = sum(size * math.sin(math.tau * rate * time) for size, rate in _TREMBLES)
        return Command(forward=1.0, direction=heading + trembling)

    return command


def keys(*strokes: tuple[float, Command]) -> Callable[[Floats], Steer]:
    """Keys held for so many seconds each, over and over; a direction counts from the route's first one."""

    def hand(route: Floats) -> Steer:
        ahead = math.atan2(*(route[1] - route[0]))
        ends = np.cumsum([seconds for seconds, _ in strokes])

        def command(time: float, x: float, z: float) -> Command:
            del x, z
            held = strokes[int(np.searchsorted(ends, time % ends[-1], side="right"))][1]
            return held if held.direction is None else replace(held, direction=ahead + held.direction)

        return command

    return hand


def _camera(degrees: float) -> Command:
    """W, A or D with a camera that looks along the route."""
    return Command(forward=1.0, direction=math.radians(degrees))


KEY_FLIPS = keys((1.0, _camera(0)), (0.3, _camera(45)), (0.7, _camera(0)), (0.3, _camera(-90)), (0.5, _camera(-45)))
STOP_AND_GO = keys((1.1, Command(forward=1.0)), (0.4, Command()), (0.3, Command(forward=1.0)), (0.5, Command()))
STRAFING = keys(
    (0.9, Command(forward=1.0)), (0.6, Command(strafe=1.0)), (0.9, Command(forward=1.0, strafe=-1.0)),
    (0.5, Command(strafe=-1.0)), (0.6, Command(forward=1.0, strafe=1.0)),
)  # fmt: skip


def steered_scenes(names: Sequence[str] = ()) -> tuple[SteeredScene, ...]:
    """All scenes, or those named; raises `InputError` if there is no such name."""
    check_steered(names)
    return tuple(make()._replace(name=name) for name, make in _made().items() if not names or name in names)


def _made() -> dict[str, Callable[[], SteeredScene]]:
    """How each scene is made, by its name: those of `STEERED`."""
    return {
        "bends": lambda: corridor("bends", 1.0),
        "narrow bends": lambda: corridor("narrow bends", 0.8),
        "slalom": slalom,
        "pillars": pillars,
        "c": lambda: _stock("c", mouse_look),
        "d": lambda: _stock("d", mouse_look),
        "d, keys": lambda: _stock("d", KEY_FLIPS),
        "c, strafing": lambda: _stock("c", STRAFING),
        "doorway": lambda: _stock("doorway", mouse_look, (_ASKEW,)),
        "course 3": lambda: _course(3),
        "course 5": lambda: _course(5),
        "traffic": lambda: _stock("traffic", STOP_AND_GO),
        "stair": stair,
    }


def corridor(name: str, width: float) -> SteeredScene:
    """A corridor of this many metres in breadth, with a bend every few metres."""
    headings = np.radians(np.concatenate([[0.0], np.cumsum(_BENDS)]))
    ways = np.stack([np.sin(headings), np.cos(headings)], axis=1)
    corners = np.cumsum(np.concatenate([[[0.0, -1.0], [0.0, 1.0 + _STRETCH]], _STRETCH * ways[1:]]), axis=0)
    lefts = np.stack([ways[:, 1], -ways[:, 0]], axis=1)
    before, after = np.concatenate([lefts[:1], lefts]), np.concatenate([lefts, lefts[-1:]])
    mitres = (before + after) / (1.0 + np.sum(before * after, axis=1, keepdims=True))
    boxes: list[tuple[Floats, float, tuple[float, float, float]]] = []
    thick, high = _WALL
    for side in (0.5 * width, -0.5 * width):
        ends = corners + side * mitres
        for a, b, heading, left in zip(ends, ends[1:], headings, lefts, strict=False):
            x, z = 0.5 * (a + b) + math.copysign(0.5 * thick, side) * left
            size = (thick, high, float(np.hypot(*(b - a))))
            boxes.append((np.array([x, 0.5 * high, z]), float(heading), size))
    return SteeredScene(name, _scene(name, corners, boxes), np.concatenate([[[0.0, 0.0]], corners[1:]]), mouse_look)


def slalom() -> SteeredScene:
    """Posts on both sides of the middle, in turns, to be walked round."""
    sides = np.where(np.arange(_POSTS) % 2 == 0, 1.0, -1.0)
    places = np.stack([_BESIDE * sides, _APART * (1.0 + np.arange(_POSTS))], axis=1)
    size = (2.0 * _POST, _WALL[1], 2.0 * _POST)
    boxes = [(np.array([x, 0.5 * _WALL[1], z]), 0.0, size) for x, z in places]
    past = np.stack([-(_PAST - _BESIDE) * sides, places[:, 1]], axis=1)
    route = np.concatenate([[[0.0, 0.0]], past, [[0.0, _APART * (_POSTS + 1.5)]]])
    return SteeredScene("slalom", _scene("slalom", route, boxes), route, mouse_look)


def pillars() -> SteeredScene:
    """Pillars in the line that a user keeps to: he looks back at it while he is led round them."""
    boxes = [
        (np.array([0.0, 0.5 * _WALL[1], _BETWEEN * (0.7 + i)]), 0.0, (broad, _WALL[1], _DEPTH))
        for i, broad in enumerate(_PILLARS)
    ]
    route = np.array([[0.0, 0.0], [0.0, _BETWEEN * len(_PILLARS)]])
    return SteeredScene("pillars", _scene("pillars", route, boxes), route, mouse_look)


def stair() -> SteeredScene:
    """Up a stair of even treads, down again on the other side, and over a sill."""
    boxes: list[tuple[Floats, float, tuple[float, float, float]]] = []
    for i in range(_TREADS):
        size = (2.0, _RISE * (i + 1), _LANDING + 2.0 * _DEEP * (_TREADS - 1 - i))
        boxes.append((np.array([0.0, 0.5 * size[1], _STAIR + _DEEP * i + 0.5 * size[2]]), 0.0, size))
    at, deep, high = _SILL
    boxes.append((np.array([0.0, 0.5 * high, at]), 0.0, (2.0, high, deep)))
    route = np.array([[0.0, 0.0], [0.0, at + 1.5]])
    return SteeredScene("stair", _scene("stair", route, boxes), route, mouse_look)


def _scene(name: str, corners: Floats, boxes: list[tuple[Floats, float, tuple[float, float, float]]]) -> Scene:
    """A scene from the middles (3,), headings and sizes of boxes, as large as its corners (m, 2) ask for."""
    turns = np.array([quaternion.about_axis(1, heading) for _, heading, _ in boxes])
    half = 0.5 * np.array([size for _, _, size in boxes])
    low, high = corners.min(axis=0) - 3.0, corners.max(axis=0) + 3.0
    x, z = corners[-1].tolist()
    names = tuple(f"{name} {i + 1}" for i in range(len(boxes)))
    return replace(
        Scene.load("empty"),
        name=name,
        title=name,
        description="Built to be steered through.",
        ground_center=tuple((0.5 * (low + high)).tolist()),
        ground_size=tuple((high - low).tolist()),
        finish=Gate((x, z), math.atan2(*(corners[-1] - corners[-2]))),
        obstacles=Obstacles.boxes([middle for middle, _, _ in boxes], turns, half, names),
    )


def _stock(name: str, hand: Callable[[Floats], Steer], past: tuple[tuple[float, float], ...] = ()) -> SteeredScene:
    scene = Scene.load(name)
    return SteeredScene(name, scene, np.array([(scene.start.x, scene.start.z), *past, scene.finish.position]), hand)


def _course(level: int) -> SteeredScene:
    course = make_course(level, _COURSE_SEED)
    route = course.line.points(np.arange(0.0, course.line.length, 0.1))
    return SteeredScene(f"course {level}", course.scene, route, mouse_look)


def wanted_way(command: Command, heading: float) -> tuple[float, float]:
    """The velocity on the ground that a command asks for, x and z in m/s, of who faces `heading`."""
    if command.direction is not None:
        ahead, left, heading = command.forward, 0.0, command.direction
    else:
        ahead, left = command.forward, 0.6 * command.strafe
    sine, cosine = _SPEED * math.sin(heading), _SPEED * math.cos(heading)
    return ahead * sine + left * cosine, ahead * cosine - left * sine
