"""The `place` of a scene document: a model beside the scene's file, or its parts packed into the document."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.world.json_place import JsonPlace
from elbowroom.world.limits import FARTHEST, NAME
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.places.floor_area import FloorArea
from elbowroom.world.places.options import AXES, PlaceOptions
from elbowroom.world.places.scene_place import MOST_PARTS, ScenePlace, packed_parts, unpacked_parts
from elbowroom.world.scene import Gate, Scene

_LONGEST_FILE, _LONGEST_DATA = 500, 256 * 2**20  # characters
_MOST_PATTERNS, _LONGEST_PATTERN = 100, 200
_MOST_VERTICES, _MOST_FACES = 6_000_000, 2_000_000
_MOST_ALONG = 1_000_000  # squares of a floor
_SHA256 = re.compile(r"[0-9a-f]{64}")
_TOLD = ("scale", "up", "ground", "drop", "passable")


def read_place_field(place: JsonPlace, folder: Path | None) -> Scene:
    """The scene of the place that a document names or carries; raises `InputError`."""
    fields = place.fields(("file",), ("sha256", *_TOLD, "parts", "data", "floor"))
    file = fields["file"].text(_LONGEST_FILE, least=1)
    options = _read_options(fields)
    digest = fields["sha256"].text(64) if "sha256" in fields else ""
    if digest and not _SHA256.fullmatch(digest):
        fields["sha256"].fail("must be a SHA-256 in 64 hexadecimal digits")
    if "floor" in fields and "data" not in fields:
        fields["floor"].fail("needs the field 'data' beside it")
    if "data" in fields:
        return _carried(fields, ScenePlace(file, digest, options, 0))
    from elbowroom.world.places.place_scene import load_place_scene

    found = load_place_scene(_beside(fields["file"], file, folder), options)
    if digest and found.place and found.place.sha256 != digest:
        raise InputError(f"{place.source}: {place.path}.file: {file} has changed: its SHA-256 is not {digest[:16]}…")
    return found


def write_place(place: ScenePlace, obstacles: Obstacles) -> dict[str, Any]:
    """The field of a document that needs no file."""
    digest = {"sha256": place.sha256} if place.sha256 else {}
    floor = {"floor": place.floor.packed()} if place.floor else {}
    return {"file": place.file, **digest, **place.options.to_dict(), **packed_parts(obstacles, place.parts), **floor}


def _carried(fields: dict[str, JsonPlace], place: ScenePlace) -> Scene:
    """The scene of parts that the document carries; ground, start and finish are told beside them."""
    if "parts" not in fields:
        fields["data"].fail("needs the field 'parts' beside it")
    rows = []
    for item in fields["parts"].items(MOST_PARTS):
        if not isinstance(item.value, list) or len(item.value) != 6:
            item.fail("must be a list of name, vertices, faces, x, y, z")
        name, vertices, faces, *center = item.items(6)
        middle = np.array([part.number(-2 * FARTHEST, 2 * FARTHEST) for part in center])
        count, corners = int(vertices.number(1, _MOST_VERTICES)), int(faces.number(1, _MOST_FACES))
        rows.append((name.text(NAME, least=1), count, corners, middle))
    data = fields["data"]
    obstacles = unpacked_parts(rows, data.text(_LONGEST_DATA), f"{data.source}: {data.path.removesuffix('.data')}")
    floor = _read_floor(fields["floor"]) if "floor" in fields else None
    carried = ScenePlace(place.file, place.sha256, place.options, len(obstacles), floor=floor)
    whole = RootState(), Gate((0.0, 1.0))
    return Scene("", "", "", (0.0, 0.0), (1.0, 1.0), *whole, obstacles, carried)


def _read_floor(place: JsonPlace) -> FloorArea:
    fields = place.fields(("origin", "cell", "shape", "data"))
    x, z = fields["origin"].vector(2, -2 * FARTHEST, 2 * FARTHEST)
    wide, deep = (int(size) for size in fields["shape"].vector(2, 1, _MOST_ALONG))
    cell, data = fields["cell"].number(0.0, FARTHEST, above=True), fields["data"].text(_LONGEST_DATA)
    return FloorArea.unpacked((x, z), cell, (wide, deep), data, f"{place.source}: {place.path}")


def _read_options(fields: dict[str, JsonPlace]) -> PlaceOptions:
    up = fields["up"].text(2) if "up" in fields else None
    if up is not None and up not in AXES:
        fields["up"].fail(f"must be one of {', '.join(AXES)}")
    return PlaceOptions(
        scale=fields["scale"].number(1e-6, 1e6) if "scale" in fields else None,
        up=up,
        ground=fields["ground"].number(-FARTHEST, FARTHEST) if "ground" in fields else None,
        drop=_patterns(fields, "drop"),
        passable=_patterns(fields, "passable"),
    )


def _patterns(fields: dict[str, JsonPlace], name: str) -> tuple[str, ...]:
    items = fields[name].items(_MOST_PATTERNS // 2) if name in fields else ()
    return tuple(item.text(_LONGEST_PATTERN, least=1) for item in items)


def _beside(field: JsonPlace, name: str, folder: Path | None) -> Path:
    """The file of that name in the scene's own folder, or below it."""
    if folder is None:
        field.fail("a scene that names a file must be loaded from a file that lies beside it")
    if ":" in name or "\\" in name or "\x00" in name or name.startswith("/") or ".." in Path(name).parts:
        field.fail("must be a file in the scene's own folder")
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        field.fail("must be a file in the scene's own folder")
    return path
