"""What a client asks for."""

from dataclasses import dataclass
from typing import Annotated

from elbowroom.server.schema.bounds import Coordinate, Heading, Name, Range, Sequence, Share


@dataclass(frozen=True)
class Input:
    """What the keys, sticks and pads say now; sent on every change and at least four times a second while held."""

    seq: Sequence  # grows with every input; frames tell the last one that they obey
    forward: Share = 0.0
    strafe: Share = 0.0  # positive to the avatar's left
    turn: Share = 0.0  # positive turns left
    direction: Heading | None = None  # wanted heading in the world (camera-relative steering)
    run: bool = False


@dataclass(frozen=True)
class Configure:
    """Choices of the menus; what is None stays. Each that does not exist is told, and those that do are taken."""

    scene: Name | None = None
    avatar: Name | None = None
    planner: Name | None = None
    queue_size: int | None = None  # one of the catalog's
    assist: bool | None = None  # False plays the canned walk, right through everything
    walk_speed: float | None = None  # m/s at forward = 1, within the catalog's limits
    style: Name | None = None  # in which it walks: one of the catalog's
    clip: Name | None = None  # play this clip; "" walks again
    clip_as_planned: bool | None = None  # play only what the planning degrees of freedom keep of it


@dataclass(frozen=True)
class ClockMessage:
    """Pause, slow motion and single steps of simulated time."""

    paused: bool | None = None
    speed: Annotated[float, Range(0.1, 2.0)] | None = None
    steps: Annotated[int, Range(1, 60)] | None = None  # steps of 1/60 s to take at once; pauses first


@dataclass(frozen=True)
class Reset:
    """Back to the start of the scene."""


@dataclass(frozen=True)
class Goto:
    """Go to a place on some floor; an input that asks for anything takes over."""

    place: tuple[Coordinate, Coordinate | None, Coordinate]  # x, height, z; no height: the floor that a way leads to


@dataclass(frozen=True)
class Push:
    """Push an obstacle over the ground, or let go of it; it stops before the body and stays where it is left."""

    obstacle: Sequence  # its number among the scene's obstacles; one that is pushable
    place: tuple[Coordinate, Coordinate] | None  # x, z, where its middle is to be; None: let go


@dataclass(frozen=True)
class Overlays:
    """Which extra data to send."""

    capsules: bool = False  # the collision body, in every pose frame
    plan: bool = False  # `plan` messages


@dataclass(frozen=True)
class Ping:
    """Answered by `pong` at once; also keeps held keys alive."""

    t: float
