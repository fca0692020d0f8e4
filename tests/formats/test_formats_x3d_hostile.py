"""X3D that wants too much: one line, soon, and no more memory than it is worth."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from elbowroom.errors import InputError
from elbowroom.formats.hanim.figure import parse_figure
from fuzzing import Reader, answer, damaged
from hanim_builder import SOLIDS, HanimRecipe, build_hanim

VRML = "#VRML V2.0 utf8\n"
SEEDS = tuple(
    build_hanim(recipe)
    for recipe in (
        HanimRecipe("xml", skinned=True, points=4),
        HanimRecipe("classic", points=4, extras=SOLIDS),
        HanimRecipe("vrml", "1.1", points=4),
    )
)
WORDS = (b"Group { children [", b"]", b"}", b"{", b"<Group>", b"</Group>", b'"', b"USE Figure", b"IS a", b"nan", b"#")
READER = Reader(lambda data: parse_figure(data, "fuzz.wrl").gltf(), SEEDS, WORDS)

BOMBS = {
    "nested PROTOs": "PROTO P0 [ ] { Group { } }\n"
    + "".join(f"PROTO P{i + 1} [ ] {{ Group {{ children [ {f'P{i} {{ }} ' * 10} ] }} }}\n" for i in range(20))
    + "P20 { }",
    "PROTO with its own argument": "PROTO A [ field MFNode c [ ] ]"
    " { Group { children [ Group { children IS c } Group { children IS c } ] } }\n" + "A { c [" * 60 + "] }" * 60,
    "USE of USE": "DEF G0 Group { }\n"
    + "".join(f"DEF G{i + 1} Group {{ children [ USE G{i} USE G{i} ] }}\n" for i in range(60)),
    "depth": "Group { children [ " * 100_000,
    "depth by PROTO": "PROTO P0 [ ] { Group { } }\n"
    + "".join(f"PROTO P{i + 1} [ ] {{ {'Group { children [' * 50} P{i} {{ }} {'] }' * 50} }}\n" for i in range(100))
    + "P100 { }",
    "grid": "Shape { geometry ElevationGrid { xDimension 1000000 zDimension 1000000 height [ 1 2 3 ] } }",
    "extrusion": f"Shape {{ geometry Extrusion {{ crossSection [ {'0 1 ' * 900} ] spine [ {'0 1 2 ' * 900} ] }} }}",
    "index": "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 ] } coordIndex [ 0 0 2000000000 ] } }",
    "picture": "Shape { geometry Box { } appearance Appearance { texture PixelTexture { image 60000 60000 3 1 } } }",
    "infinite": "Transform { translation 1e999 0 0 }",
}


@pytest.mark.parametrize("name", [name for name in BOMBS if name not in ("PROTO with its own argument", "picture")])
def test_bombs_are_refused(name: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_figure((VRML + BOMBS[name]).encode(), "bomb.wrl")
    assert str(caught.value).startswith("bomb.wrl")
    assert "\n" not in str(caught.value)


def test_what_is_shared_is_not_copied() -> None:
    """A PROTO that shows its argument twice, sixty deep: few nodes, but endlessly many ways through them."""
    with pytest.raises(InputError, match="more than 100000 nodes are shown"):
        parse_figure((VRML + BOMBS["PROTO with its own argument"]).encode(), "a.wrl")


def test_a_picture_that_is_none() -> None:
    assert parse_figure((VRML + BOMBS["picture"]).encode(), "a.wrl").notes == ()  # a Box has no use for it here
    faces = BOMBS["picture"].replace(
        "Box { }", "IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 0 0 0 1 0 ] } coordIndex [ 0 1 2 ] }"
    )
    with pytest.raises(InputError, match="that is no picture"):
        parse_figure((VRML + faces).encode(), "a.wrl")


@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 2**32))
def test_damaged_files(seed: int) -> None:
    answer(READER, damaged(READER, np.random.default_rng(seed)))


@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(st.sampled_from([b"{", b"}", b"[", b"]", b"A", b"DEF", b"USE", b"PROTO", b"1", b'"a"', b"IS", b"#"])))
def test_words_in_any_order(words: list[bytes]) -> None:
    answer(READER, VRML.encode() + b" ".join(words))
