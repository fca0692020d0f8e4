"""What a viewer shows of a place whose file is odd: a GLB, or one line."""

import json
import struct
from typing import Any

import pytest

from elbowroom.errors import InputError
from elbowroom.formats.packing import write_glb
from elbowroom.world.places.reading import parse_place
from elbowroom.world.places.shown import shown_glb
from place_builder import glb

ROOM = glb({"Floor": ((0, -0.1, 0), (4, 0.2, 4)), "Wall": ((1.5, 1, 0), (0.2, 2, 4))})


def with_json(text: str) -> bytes:
    """The room with members added to its JSON."""
    (length,) = struct.unpack_from("<I", ROOM, 12)
    content = json.loads(ROOM[20 : 20 + length]) | json.loads(text)
    content["meshes"] += content.pop("more_meshes", [])
    return write_glb(content, ROOM[28 + length :]).replace(b'"infinite"', b"1e99999999")


def shown(data: bytes) -> dict[str, Any]:
    """The JSON of what a viewer gets."""
    packed = shown_glb(parse_place(data, "room.glb"), 0.0)
    (length,) = struct.unpack_from("<I", packed, 12)
    return dict(json.loads(packed[20 : 20 + length]))


@pytest.mark.parametrize(
    "added", ['{"materials": null}', '{"more_meshes": [{}, {"primitives": null}]}', '{"scene": null}']
)
def test_what_is_null_or_left_out_is_not_there(added: str) -> None:
    plain = shown(ROOM)
    content = shown(with_json(added))
    assert content["nodes"] == plain["nodes"]
    assert content["materials"] == plain["materials"]


@pytest.mark.parametrize(
    ("added", "told"), [('{"materials": {}}', "materials"), ('{"extras": "infinite"}', "too large a number")]
)
def test_what_could_not_be_passed_on_is_refused(added: str, told: str) -> None:
    with pytest.raises(InputError, match=told):
        shown(with_json(added))
