"""What a dataset consists of, as a JSON file says it."""

import json
import math
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.levels import level_of
from elbowroom.planning.names import DEFAULT_PLANNER, check_planner
from elbowroom.world.json_place import read_json

COURSES = "gauntlet:"
STOCK = "stock"
STYLE = "style:"
STEERING = ("straight", "mouse look", "key flips", "stop and go", "strafing", "tour")  # as `hands` has them
RATES = (60, 30, 20)  # frames a second: every frame, every second, every third
MOST_WALKS = 10_000_000
_MOST_BYTES = 1_000_000  # of a file
_MOST_CHOICES = 1000
_LONGEST = 600.0  # seconds of a walk
_MOST_OTHERS = 8


@dataclass(frozen=True)
class DatasetSpec:
    """Each walk draws one of the places, avatars, swings and steerings by its number and the seed.

    Raises `InputError` for what is out of range or unknown.
    """

    walks: int = 1000  # that are drawn; those that are not clean are listed and left out
    seed: int = 0
    fps: int = 30  # frames a second: 60, 30 or 20
    places: tuple[str, ...] = ("gauntlet:3",)  # random courses of a level, stock scenes by name, files of scenes
    avatars: tuple[str, ...] = (STOCK,)  # or files
    swings: tuple[str, ...] = (STOCK,)  # or style:NAME, or motions that are walked as, FILE or FILE#CLIP
    steering: tuple[str, ...] = ("straight",)  # of `STEERING`
    company: tuple[int, ...] = (0,)  # how many others walk about in the same place
    seconds: float = 20.0  # at most, of each walk
    planner: str = DEFAULT_PLANNER
    shard: int = 100  # walks that are drawn for one file
    name: str = "walks"
    license: str = ""  # of the dataset, for its card

    def __post_init__(self) -> None:
        for name, most in (("walks", MOST_WALKS), ("shard", 10_000)):
            if not 1 <= getattr(self, name) <= most:
                raise InputError(f"{name}: {getattr(self, name)} is not between 1 and {most}")
        if not 0 <= self.seed < 2**31:
            raise InputError(f"seed: {self.seed} is not between 0 and {2**31 - 1}")
        if self.fps not in RATES:
            raise InputError(f"fps: {self.fps} is none of {', '.join(map(str, RATES))}")
        if not 1.0 <= self.seconds <= _LONGEST:
            raise InputError(f"seconds: {self.seconds:g} is not between 1 and {_LONGEST:g}")
        for name in ("places", "avatars", "swings", "steering"):
            if not 1 <= len(getattr(self, name)) <= _MOST_CHOICES:
                raise InputError(f"{name}: give 1 to {_MOST_CHOICES}")
        if not 1 <= len(self.company) <= _MOST_CHOICES or not all(0 <= n <= _MOST_OTHERS for n in self.company):
            raise InputError(f"company: give 1 to {_MOST_CHOICES} numbers of others, each from 0 to {_MOST_OTHERS}")
        for place in self.places:
            level(place)
        for hand in self.steering:
            if hand not in STEERING:
                raise InputError(f"steering: {hand[:40]!r} is none of {', '.join(STEERING)}")
        check_planner(self.planner)

    @classmethod
    def load(cls, path: Path) -> "DatasetSpec":
        """Read a JSON file; raises `InputError` that names the file. Files in it are found beside it."""
        given = read_json(path, _MOST_BYTES)
        try:
            return cls.of(given)._beside(path.parent)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None

    @classmethod
    def of(cls, given: Any) -> "DatasetSpec":
        """From JSON data; raises `InputError` for unknown names and wrong kinds."""
        if not isinstance(given, dict):
            raise InputError("is no JSON object")
        kinds: dict[str, Any] = {field.name: field.default for field in fields(cls)}
        for name, value in given.items():
            if name not in kinds:
                raise InputError(f"{str(name)[:40]!r} is none of {', '.join(kinds)}")
            if not _is_like(value, kinds[name]):
                raise InputError(f"{name}: {str(value)[:40]!r} is not of the kind of {json.dumps(kinds[name])}")
        values: dict[str, Any] = {
            name: tuple(value) if isinstance(value, list) else value for name, value in given.items()
        }
        return cls(**values)

    def _beside(self, folder: Path) -> "DatasetSpec":
        """The same with files found from a folder."""

        def found(name: str) -> str:
            of_file = "." in name and not name.startswith(STYLE) and not Path(name).is_absolute()
            return str(folder / name) if of_file else name

        lists = {name: tuple(map(found, getattr(self, name))) for name in ("places", "avatars", "swings")}
        return type(self)(**asdict(self) | lists)


def level(place: str) -> int | None:
    """The level of a place that means random courses, else None; raises `InputError` for a wrong one."""
    if not place.startswith(COURSES):
        return None
    number = place.removeprefix(COURSES)
    if not number.isdecimal():
        raise InputError(f"places: {place[:40]!r} is not as {COURSES}3")
    level_of(int(number))
    return int(number)


def _is_like(value: Any, default: Any) -> bool:
    if isinstance(default, tuple):
        return isinstance(value, list) and all(type(entry) is type(default[0]) for entry in value)
    if isinstance(default, float):
        return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    return type(value) is type(default)
