"""X3D in XML as a node graph: the same as Classic says, and nothing that a stranger's XML could do to us."""

import gzip
from pathlib import Path

import numpy as np
import pytest

from elbowroom.errors import InputError
from elbowroom.formats.x3d.expand import expand
from elbowroom.formats.x3d.files import MAX_BYTES, FilesBeside, parse_x3d
from elbowroom.formats.x3d.model import Node, Notes
from hanim_builder import HanimRecipe, build_hanim

HEAD = '<?xml version="1.0"?><!DOCTYPE X3D PUBLIC "a" "http://nowhere.test/x3d.dtd"><X3D version="4.0">'


def expanded(scene: str) -> list[Node]:
    notes = Notes()
    return expand(parse_x3d(f"{HEAD}<Scene>{scene}</Scene></X3D>".encode(), "a.x3d", notes), FilesBeside(None, notes))


def test_containers_are_those_of_the_standard_or_of_the_file() -> None:
    (shape,) = expanded(
        "<Shape DEF='S'><Appearance><Material/><ImageTexture url='\"a.png\" \"b.png\"'/></Appearance>"
        "<IndexedFaceSet coordIndex='0 1 2 -1' solid='false'><Coordinate point='0 0 0, 1 0 0, 0 1 0'/></IndexedFaceSet>"
        "<MetadataString name='n' containerField='metadata' value='\"v\"'/></Shape>"
    )
    appearance, geometry = shape.node("appearance"), shape.node("geometry")
    assert appearance is not None
    assert geometry is not None
    texture, coord = appearance.node("texture"), geometry.node("coord")
    assert texture is not None
    assert coord is not None
    assert texture.strings("url") == ("a.png", "b.png")
    assert coord.vectors("point", 3).shape == (3, 3)
    assert geometry.flag("solid", True) is False
    assert shape.node("metadata") is not None


def test_protos_of_xml() -> None:
    (first, second) = expanded(
        """<ProtoDeclare name='P'><ProtoInterface>
             <field accessType='inputOutput' name='at' type='SFVec3f' value='1 2 3'/>
             <field accessType='initializeOnly' name='inside' type='MFNode'><Box/></field>
             <field accessType='inputOnly' name='go' type='SFBool'/>
           </ProtoInterface><ProtoBody>
             <Transform><IS><connect nodeField='translation' protoField='at'/>
               <connect nodeField='children' protoField='inside'/></IS></Transform>
           </ProtoBody></ProtoDeclare>
           <ProtoInstance name='P' DEF='A'/>
           <ProtoInstance name='P'><fieldValue name='at' value='4 5 6'/>
             <fieldValue name='inside'><Cone/><Sphere/></fieldValue></ProtoInstance>"""
    )
    assert first.name == "A"
    assert first.vector("translation", (0, 0, 0)).tolist() == [1, 2, 3]
    assert [node.kind for node in first.nodes("children")] == ["Box"]
    assert second.vector("translation", (0, 0, 0)).tolist() == [4, 5, 6]
    assert [node.kind for node in second.nodes("children")] == ["Cone", "Sphere"]


@pytest.mark.parametrize("skinned", [False, True])
def test_all_encodings_say_the_same(skinned: bool) -> None:
    graphs = []
    for encoding in ("xml", "classic", "vrml"):
        notes = Notes()
        data = build_hanim(HanimRecipe(encoding, skinned=skinned))
        graphs.append(expand(parse_x3d(data, "made.wrl", notes), FilesBeside(None, notes)))
    for other in graphs[1:]:
        for a, b in zip(graphs[0], other, strict=True):
            compare(a, b)


def compare(a: Node, b: Node) -> None:
    """Two nodes and all below them: the same kinds, names and values."""
    assert (a.kind, a.name) == (b.kind, b.name)
    assert a.fields.keys() <= b.fields.keys()
    for name, value in b.fields.items():
        if isinstance(value, np.ndarray):
            assert np.array_equal(a.numbers(name), value)
        elif isinstance(value, tuple):
            assert a.text(name) == b.text(name)
        else:
            for child, other in zip(a.nodes(name), b.nodes(name), strict=True):
                if name != "joints":
                    compare(child, other)


@pytest.mark.parametrize(
    "subset",
    [
        '<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">',
        '<!ENTITY x SYSTEM "file:///etc/passwd">',
        '<!ENTITY % p "x">',
        '<!ATTLIST Group a CDATA "x">',
        "<!ELEMENT Group ANY>",
        "",
    ],
)
def test_a_document_type_may_declare_nothing(subset: str) -> None:
    document = f"<!DOCTYPE X3D [{subset}]><X3D><Scene><Group/></Scene></X3D>"
    with pytest.raises(InputError, match=r"a\.x3d: line 1: the document type declares"):
        parse_x3d(document.encode(), "a.x3d", Notes())


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"<X3D><Scene><Box></Scene></X3D>", "line 1, column 20: mismatched tag"),
        (b"<html></html>", "the first element is <html>"),
        (b"<?xml version='1.0' encoding='nonsense'?><X3D/>", "text encoding is not known"),
        (b"<X3D>" + b"<Group>" * 500, "nested more than 400 deep"),
        (b"#VRML V1.0 ascii\nSeparator { }", "VRML 1.0"),
        (b"solid cube", "VRML97 starts with"),
        (gzip.compress(b" " * (MAX_BYTES + 2), 9, mtime=0), "more than 64 MB"),
        (gzip.compress(b"#VRML V2.0 utf8", mtime=0)[:-9], "the file was cut off"),
    ],
)
def test_refusals(data: bytes, told: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_x3d(data, "a.x3d", Notes())
    assert told in str(caught.value)


def test_files_beside_the_scene(tmp_path: Path) -> None:
    """Inline and EXTERNPROTO from the scene's folder and below it; nothing else, whatever is asked for."""
    (tmp_path / "scene" / "parts").mkdir(parents=True)
    (tmp_path / "secret.wrl").write_text("#VRML V2.0 utf8\nBox { }")
    (tmp_path / "scene" / "link.wrl").symlink_to(tmp_path / "secret.wrl")
    (tmp_path / "scene" / "parts" / "ball.wrl").write_text(
        '#VRML V2.0 utf8\nPROTO Ball [ field SFFloat r 1 ] { Sphere { radius IS r } }\nInline { url [ "cone.wrl" ] }'
    )
    (tmp_path / "scene" / "parts" / "cone.wrl").write_text("#VRML V2.0 utf8\nCone { }")
    scene = """#VRML V2.0 utf8
EXTERNPROTO Ball [ field SFFloat r ] [ "http://nowhere.test/ball.wrl#Ball" "parts/ball.wrl#Ball" ]
Ball { r 3 }
Inline { url "parts/ball.wrl" }
Inline { url [ "../secret.wrl" "link.wrl" "file:///etc/passwd" "http://nowhere.test/a.wrl" "/etc/passwd" "" ] }
"""
    notes = Notes()
    library = FilesBeside(tmp_path / "scene", notes)
    ball, group = expand(parse_x3d(scene.encode(), "a.wrl", notes), library)
    assert (ball.kind, ball.number("radius", 0.0)) == ("Sphere", 3)
    assert [node.kind for inner in group.nodes("children") for node in inner.nodes("children")] == ["Cone"]
    assert [line.split(": ")[1] for line in notes.lines] == ["line 5"]
    alone = Notes()
    assert expand(parse_x3d(scene.encode(), "a.wrl", alone), FilesBeside(None, alone)) == []
    assert len(alone.lines) == 3


def test_a_file_that_takes_itself_in(tmp_path: Path) -> None:
    (tmp_path / "a.wrl").write_text(
        '#VRML V2.0 utf8\nGroup { children [ Inline { url "a.wrl" } Inline { url "a.wrl" } ] }'
    )
    notes = Notes()
    with pytest.raises(InputError, match="more than"):
        expand(parse_x3d((tmp_path / "a.wrl").read_bytes(), "a.wrl", notes), FilesBeside(tmp_path, notes))
