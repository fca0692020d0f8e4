"""VRML97 and X3D Classic as a node graph."""

import numpy as np
import pytest

from elbowroom.errors import InputError
from elbowroom.formats.x3d.expand import expand
from elbowroom.formats.x3d.files import FilesBeside, parse_x3d
from elbowroom.formats.x3d.model import Node, Notes, X3dScene

VRML = "#VRML V2.0 utf8\n"


def parsed(text: str, header: str = VRML) -> tuple[X3dScene, Notes]:
    notes = Notes()
    return parse_x3d((header + text).encode(), "a.wrl", notes), notes


def expanded(text: str, header: str = VRML) -> list[Node]:
    scene, notes = parsed(text, header)
    return expand(scene, FilesBeside(None, notes))


def test_values_of_every_shape() -> None:
    node = parsed(
        """Shape { # a comment with a ] and a "
          a 1, 2 3.5 -4e-1 +.5 0x1F  b [ 1 2, # three ]
            3 ] c TRUE d [ TRUE FALSE ] e "t\\"x\\\\" f [ "one", "two # no comment" ] g NULL h [ ]
          geometry Box { size 1 2 3 } children [ DEF A Group { } USE A, ] }"""
    )[0].roots[0]
    assert node.numbers("a").tolist() == [1, 2, 3.5, -0.4, 0.5, 31]
    assert node.numbers("b").tolist() == [1, 2, 3]
    assert node.flag("c", False) is True
    assert node.numbers("d").tolist() == [1, 0]
    assert node.text("e") == 't"x\\'
    assert node.strings("f") == ("one", "two # no comment")
    assert (node.node("g"), node.nodes("h"), node.strings("h"), len(node.numbers("h"))) == (None, [], (), 0)
    box = node.node("geometry")
    assert box is not None
    assert box.vector("size", (0, 0, 0)).tolist() == [1, 2, 3]
    assert box.line == 5
    first, second = node.nodes("children")
    assert first is second


def test_statements_that_are_no_nodes_are_passed_over() -> None:
    scene, notes = parsed(
        'PROFILE Immersive COMPONENT HAnim:1 META "creator" "me" UNIT length inch 0.0254 UNIT angle degree 0.01745\n'
        "DEF T Transform { ROUTE a.b TO c.d children Script { eventIn SFBool on field SFNode n NULL"
        ' field MFString s [ "a" ] url "javascript: x" eventOut SFBool off } } ROUTE T.a TO T.b EXPORT T AS U\n',
        "#X3D V3.3 utf8\n",
    )
    assert [node.kind for node in scene.roots] == ["Transform"]
    assert scene.meta == {"creator": "me"}
    assert (scene.metre, scene.radian) == (0.0254, 0.01745)
    assert not notes.lines


def test_use_of_an_unknown_or_enclosing_name_is_left_out() -> None:
    scene, notes = parsed("DEF A Group { children [ USE A USE B ] }")
    assert scene.roots[0].nodes("children") == []
    assert [line.split(": ")[1] for line in notes.lines] == ["line 2", "line 2"]


PROTO = """PROTO P [ field SFVec3f at 1 2 3 field MFNode inside [ Sphere { } ] eventIn SFBool go ] {
  DEF X Transform { translation IS at children IS inside set_x IS go }
  Group { }
}
"""


def test_a_proto_stands_for_its_first_node() -> None:
    first, second = expanded(PROTO + "P { } DEF Q P { at 4 5 6 inside [ Box { } P { } ] }")
    assert (first.kind, first.name, second.name) == ("Transform", "X", "Q")
    assert first.vector("translation", (0, 0, 0)).tolist() == [1, 2, 3]
    assert [node.kind for node in first.nodes("children")] == ["Sphere"]
    assert second.vector("translation", (0, 0, 0)).tolist() == [4, 5, 6]
    assert [node.kind for node in second.nodes("children")] == ["Box", "Transform"]
    assert not first.has("set_x")


def test_protos_within_protos_have_names_of_their_own() -> None:
    (node,) = expanded(
        "PROTO A [ field SFFloat r 1 ] { DEF N Group { PROTO B [ field SFFloat s 2 ] { Sphere { radius IS s } }"
        " children [ B { s IS r } USE N ] } } A { r 7 }"
    )
    (sphere,) = node.nodes("children")
    assert sphere.number("radius", 0.0) == 7


def test_instances_do_not_share_nodes() -> None:
    a, b = expanded("PROTO A [ ] { Group { children DEF S Shape { } } } A { } A { }")
    assert a.nodes("children")[0] is not b.nodes("children")[0]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Group { children [ Box { }", "line 2, column 27: a node or ']' is needed, not the end of the file"),
        ("Group {\n  children [ 1 two ] }", "line 3"),
        ("Box { size 1 2 three }", "line 2, column 22: a value of three"),
        ('WorldInfo { title "never ends }', "line 2: the text that begins here never ends"),
        ("}", "line 2, column 1: a node is needed"),
        ("Group { children Box }", "line 2, column 22: '{' after Box is needed, not '}'"),
        ("PROTO P [ field SFNode ] { }", "line 2"),
        ("Shape { point [ 1 2 1.2.3 ] }", "'1.2.3' is not a number"),
    ],
)
def test_errors_name_the_place(text: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        expanded(text)
    assert str(caught.value).startswith("a.wrl")
    assert told in str(caught.value)


def test_numbers_are_those_of_python() -> None:
    rng = np.random.default_rng(0)
    values = rng.normal(size=(4000, 3)) * 10.0 ** rng.integers(-8, 5, (4000, 3))
    text = ", ".join(" ".join(repr(float(number)) for number in row) for row in values)
    (node,) = parsed(f"Coordinate {{ point [ {text} ] }}")[0].roots
    assert np.array_equal(node.vectors("point", 3), values)
