"""Moving obstacles in scene documents: the part of reader and writer that knows tracks."""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from elbowroom.errors import InputError
from elbowroom.world.json_place import JsonPlace
from elbowroom.world.limits import FARTHEST, NAME, read_angle
from elbowroom.world.obstacles.tracks.moving import FASTEST, Moving, Repeat, Track
from elbowroom.world.shape_format import FIELDS, read_shape, type_of, write_shape

MAX_MOVING = 100
MAX_KEYS = 1_000
_SHORTEST, _LONGEST = 0.01, 3_600.0  # seconds between key poses


class _Key(NamedTuple):
    place: JsonPlace
    center: list[float]
    yaw: float
    seconds: float  # until the next


def read_moving(place: JsonPlace) -> Moving:
    """The tracks in a list; raises `InputError` at the first wrong field."""
    return Moving(tuple(_read_track(item, i) for i, item in enumerate(place.items(MAX_MOVING))))


def _read_track(place: JsonPlace, index: int) -> Track:
    kind = type_of(place)
    fields = place.fields(("type", *FIELDS[kind], "track"), ("name", "color", "repeat"))
    name = fields["name"].text(NAME, least=1) if "name" in fields else f"moving {kind} {index + 1}"
    repeat = _read_repeat(fields["repeat"]) if "repeat" in fields else Repeat.LOOP
    shape = read_shape(kind, fields)
    keys = [_read_key(item) for item in fields["track"].items(MAX_KEYS)]
    if len(keys) < 2:
        fields["track"].fail("must have at least 2 key poses; what stands still is an obstacle")
    closed = [*keys, keys[0]] if repeat is Repeat.LOOP else keys
    _refuse_leaps(closed)
    times = np.cumsum([0.0, *(key.seconds for key in closed[:-1])])
    return Track(
        name, shape, times, np.array([key.center for key in closed]), np.array([key.yaw for key in closed]),
        repeat,
    )  # fmt: skip


def _read_repeat(place: JsonPlace) -> Repeat:
    names = [repeat.value for repeat in Repeat]
    if not isinstance(place.value, str) or place.value not in names:
        place.fail(f"must be one of {', '.join(names)}")
    return Repeat(place.value)


def _read_key(place: JsonPlace) -> _Key:
    fields = place.fields(("center", "seconds"), ("yaw",))
    center = fields["center"].vector(3, -FARTHEST, FARTHEST)
    yaw = read_angle(fields["yaw"]) if "yaw" in fields else 0.0
    return _Key(place, center, yaw, fields["seconds"].number(_SHORTEST, _LONGEST))


def _refuse_leaps(keys: list[_Key]) -> None:
    for key, following in pairwise(keys):
        speed = float(np.linalg.norm(np.subtract(following.center, key.center))) / key.seconds
        fastest = max(speed, abs(following.yaw - key.yaw) / key.seconds)
        if fastest > FASTEST:
            most = f"at most {FASTEST:g} m/s and rad/s are allowed: give it more seconds"
            raise InputError(f"{key.place.source}: {key.place.path} leads on at {fastest:.3g}; {most}")


def write_moving(moving: Moving) -> list[dict[str, Any]]:
    """The list in a scene's JSON document."""
    return [_written(track) for track in moving.tracks]


def _written(track: Track) -> dict[str, Any]:
    keys = len(track.times) - (track.repeat is Repeat.LOOP)
    seconds = [*np.diff(track.times).tolist(), 1.0][:keys]
    rows = zip(track.centers[:keys].tolist(), track.yaws[:keys].tolist(), seconds, strict=True)
    poses = [{"center": center, "yaw": yaw, "seconds": wait} for center, yaw, wait in rows]
    shape = write_shape(track.shape)
    return {"type": shape.pop("type"), "name": track.name, **shape, "repeat": track.repeat.value, "track": poses}
