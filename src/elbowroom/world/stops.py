"""The stops of a guided tour through a scene: where one stands, from where that is looked at, what is said there."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from elbowroom.world.json_place import JsonPlace
from elbowroom.world.limits import FARTHEST

VIEWS = ("behind", "side", "front", "above", "orbit", "shoulder")  # the cameras of the page
MAX_STOPS = 100
_PROSE = 300  # characters
_LONGEST = 600.0  # seconds


@dataclass(frozen=True)
class Stop:
    """A place of a tour."""

    position: tuple[float, float]  # x, z, metres
    height: float | None = None  # of the floor there, metres; None: the one that a way leads to
    view: str = ""  # one of `VIEWS`, or "": the camera stays as it is
    say: str = ""  # shown to people
    seconds: float = 3.0  # how long one stays


def read_tour(place: JsonPlace) -> tuple[Stop, ...]:
    """The stops in a list, in order; raises `InputError` at the first wrong field."""
    return tuple(_read_stop(item) for item in place.items(MAX_STOPS))


def _read_stop(place: JsonPlace) -> Stop:
    fields = place.fields(("position",), ("view", "say", "seconds"))
    x, *height, z = _position(fields["position"])
    view = fields["view"].value if "view" in fields else Stop.view
    if view not in ("", *VIEWS):
        fields["view"].fail(f"must be one of {', '.join(VIEWS)}, or empty")
    return Stop(
        (x, z),
        height[0] if height else None,
        str(view),
        fields["say"].text(_PROSE) if "say" in fields else Stop.say,
        fields["seconds"].number(0.0, _LONGEST) if "seconds" in fields else Stop.seconds,
    )


def _position(place: JsonPlace) -> list[float]:
    """`[x, z]` or `[x, height, z]`."""
    size = len(place.value) if isinstance(place.value, list) else 0
    if size not in (2, 3):
        place.fail("must be a list of 2 numbers, x and z, or of 3, x, height and z")
    return place.vector(size, -FARTHEST, FARTHEST)


def write_tour(stops: Sequence[Stop]) -> list[dict[str, Any]]:
    """The list in a scene's JSON document."""
    return [{"position": _written(stop), "view": stop.view, "say": stop.say, "seconds": stop.seconds} for stop in stops]


def _written(stop: Stop) -> list[float]:
    x, z = stop.position
    return [x, z] if stop.height is None else [x, stop.height, z]
