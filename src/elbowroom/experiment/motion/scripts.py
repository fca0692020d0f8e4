"""What is walked to be measured: steady at some speeds, and whatever else a user does with the keys."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from elbowroom.body.root import RootState
from elbowroom.experiment.bench.steer_scenes import slalom
from elbowroom.experiment.motion.settings import SPEEDS, STEADY, check_cases, check_speed
from elbowroom.planning.command import Command
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.scene import Scene

Hand = Callable[[float, RootState], Command]  # seconds since the start, where the avatar is

TURN_AT = 2.0  # seconds, when the walk `turn 90` is told to turn
_AHEAD = Command(forward=1.0)
_OPEN = 40.0  # metres of empty ground ahead
_SETTLED = 2.5  # seconds after which a steady walk is measured
_WIDE, _TREAD, _RISE, _STEPS = 1.8, 0.28, 0.17, 4  # metres, of a stair; its steps
_SLOPE, _RAMP, _TOP = math.radians(12.0), 2.0, 1.5  # of a ramp; metres along it, and of the level ground on top
_OFFSETS = (0.0, 0.13, 0.26, 0.39)  # seconds: a start and a stop at other places of the stride
_BEGINS = (2.0, 2.09, 2.18, 2.27)  # metres from the start: a stair, a ramp and a sill at other places of the stride


class Script(NamedTuple):
    """One walk to measure."""

    name: str
    scene: Scene
    hand: Hand
    seconds: float
    speed: float = 0.0  # m/s, of a steady walk; 0 for any other
    settled: float = 0.0  # seconds from the start that are not measured

    @property
    def case(self) -> str:
        """What it is counted under."""
        return STEADY if self.speed > 0.0 else self.name.rstrip(" 0123456789")


def scripts(names: Sequence[str] = (), speeds: Sequence[float] = SPEEDS) -> tuple[Script, ...]:
    """All walks, or those named by case, of `SCRIPTED`; raises `InputError` if there is no such case."""
    check_cases(names)
    every = [steady(speed) for speed in speeds] + [*_on_open_ground(), *_among_things(), *_on_uneven_ground()]
    return tuple(script for script in every if not names or script.case in names)


def steady(speed: float) -> Script:
    """Straight ahead at a speed in m/s, on open ground."""
    return Script(f"{STEADY} {speed:g}", open_ground(), _held(at_speed(speed)), 8.0, speed, _SETTLED)


def at_speed(speed: float) -> Command:
    """The command that walks straight ahead so fast, m/s; raises `InputError` if nobody does."""
    check_speed(speed)
    settings = RootMotionSettings()
    run = speed > settings.walk_speed
    return Command(forward=speed / (settings.run_speed if run else settings.walk_speed), run=run)


def open_ground() -> Scene:
    """Nothing in the way."""
    return Scene.of("open ground", [], finish=(0.0, _OPEN))


def strokes(*held: tuple[float, Command]) -> Hand:
    """Keys that are held for so many seconds each; the last one stays."""

    def hand(time: float, root: RootState) -> Command:
        del root
        for seconds, command in held:
            if time < seconds:
                return command
            time -= seconds
        return held[-1][1]

    return hand


def _held(command: Command) -> Hand:
    return strokes((math.inf, command))


def _on_open_ground() -> list[Script]:
    still, turned = Command(), Command(forward=1.0, direction=math.pi / 2)
    made = [
        Script(f"start {i}", open_ground(), strokes((0.4, still), (later, _AHEAD), (0.3, still), (9.0, _AHEAD)), 3.0)
        for i, later in enumerate(_OFFSETS, 1)
    ]
    made += [
        Script(f"stop {i}", open_ground(), strokes((2.0 + later, _AHEAD), (9.0, still)), 4.5)
        for i, later in enumerate(_OFFSETS, 1)
    ]
    other = {
        "turn 90": (strokes((TURN_AT, Command(forward=1.0, direction=0.0)), (9.0, turned)), 5.0),
        "change of direction": (
            strokes(*((0.8, Command(forward=1.0, direction=math.radians(angle))) for angle in (0, 60, -30, 150, 0))),
            4.5,
        ),
        "turn in place": (
            strokes((0.3, still), (2.5, Command(turn=1.0)), (0.4, still), (2.0, Command(turn=-0.4))),
            5.5,
        ),
        "strafe": (strokes((2.0, Command(strafe=1.0)), (0.5, still), (2.0, Command(strafe=-1.0)), (9.0, still)), 5.5),
        "back": (strokes((1.0, _AHEAD), (2.5, Command(forward=-1.0)), (9.0, still)), 5.0),
        "circle": (strokes((9.0, Command(forward=1.0, turn=0.4))), 5.0),
        "there and back": (strokes((1.5, _AHEAD), (1.5, Command(forward=1.0, direction=math.pi)), (9.0, still)), 4.5),
    }
    return made + [Script(name, open_ground(), hand, seconds) for name, (hand, seconds) in other.items()]


def _among_things() -> list[Script]:
    posts = slalom()
    mouse = posts.hand(posts.route)
    return [
        Script("crouch", Scene.load("beam"), _held(_AHEAD), 9.0),
        Script("doorway", Scene.load("doorway"), _held(_AHEAD), 9.0),
        Script("slalom", posts.scene, lambda time, root: mouse(time, root.x, root.z), 9.0),
    ]


def _on_uneven_ground() -> list[Script]:
    """Up and down again: a stair, a ramp and a sill."""
    made = [
        ("stair", _stair, 2.0 * _TREAD * _STEPS + _TOP, 18.0),
        ("ramp", _ramp, 2.0 * _RAMP + _TOP, 12.0),
        ("sill", _sill, 0.0, 6.0),
    ]
    return [
        Script(f"{name} {i}", Scene.of(name, of(begin), finish=(0.0, begin + along + 2.0)), _held(_AHEAD), seconds)
        for name, of, along, seconds in made
        for i, begin in enumerate(_BEGINS, 1)
    ]


def _block(begin: float, length: float, top: float) -> dict[str, Any]:
    return {"type": "box", "center": [0.0, 0.5 * top, begin + 0.5 * length], "size": [_WIDE, top, length]}


def _sill(begin: float) -> list[dict[str, Any]]:
    return [_block(begin, 0.1, 0.1)]


def _stair(begin: float) -> list[dict[str, Any]]:
    """Each step a block that goes through below those above it."""
    whole = 2.0 * _TREAD * _STEPS + _TOP
    return [_block(begin + _TREAD * i, whole - 2.0 * _TREAD * i, _RISE * (i + 1)) for i in range(_STEPS)]


def _ramp(begin: float) -> list[dict[str, Any]]:
    half, top = 0.5 * _WIDE, math.tan(_SLOPE) * _RAMP
    ends = ((0.0, 0.0), (_RAMP, top), (_RAMP + _TOP, top), (2.0 * _RAMP + _TOP, 0.0))
    points = [[x, height, along] for x in (-half, half) for along, height in ends]
    return [{"type": "hull", "points": points, "center": [0.0, 0.0, begin]}]
