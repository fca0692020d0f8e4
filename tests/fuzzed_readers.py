"""What `tools/fuzz_readers.py` throws damaged files at: every reader of what comes from outside.

A reader of one's own is registered in `READERS`: how it reads bytes, a few good files, and pieces of its grammar.
"""

import gzip
import json
import struct
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fuzzing import Container, Reader

if TYPE_CHECKING:
    from elbowroom.formats.takes import Take


def _chunks(data: bytes) -> list[bytes]:
    """The contents of a good GLB's chunks."""
    chunks, at = [], 12
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        chunks.append(data[at + 8 : at + 8 + size])
        at += 8 + size
    return chunks


def _glb(chunks: list[bytes]) -> bytes:
    """A GLB of JSON and one buffer, whatever is in them."""
    kinds = (b"JSON", b"BIN\0")
    even = [chunk + b" " * (-len(chunk) % 4) for chunk in chunks]
    body = b"".join(struct.pack("<I", len(chunk)) + kind + chunk for chunk, kind in zip(even, kinds, strict=False))
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


GLB = Container(_chunks, _glb)
GZIP = Container(lambda data: [gzip.decompress(data)], lambda parts: gzip.compress(parts[0], 1))


def glb_reader() -> Reader:
    """GLB and VRM humanoids."""
    from avatar_builder import MIXAMO, Recipe, build
    from elbowroom.body.loading.avatar_file import load_humanoid_bytes

    recipes = (Recipe(vrm="1", points=2, spin=True), Recipe(vrm="0", points=2), Recipe(names=MIXAMO, points=2))
    words: tuple[bytes, ...] = (
        b"[[[[",
        b'{"a":',
        b'"nodes":',
        b"]",
        b"}",
        b'"children":[0]',
        b'"uri":"../x"',
        b'"count":1e9',
        b"null",
    )
    return Reader(lambda data: load_humanoid_bytes(data, "fuzz.glb"), tuple(map(build, recipes)), words, GLB)


def compressed_reader() -> Reader:
    """GLB humanoids with Draco and meshoptimizer streams."""
    from avatar_builder import Recipe, build
    from compressed_builder import draco_file
    from compressed_vrm import with_meshopt
    from elbowroom.body.loading.avatar_file import load_humanoid_bytes
    from elbowroom.formats.meshopt.index_codec import decode_sequence, decode_triangles

    words = (
        b'"mode":"TRIANGLES"',
        b'"count":4999999',
        b'"byteStride":256',
        b'"filter":"OCTAHEDRAL"',
        b"DRACO",
        b"\xe1",
    )
    seeds = (with_meshopt(build(Recipe(points=2))), draco_file(each=3)[0])
    decode_triangles(np.zeros(1, np.uint8), 3)  # compiled before the clock runs
    decode_sequence(np.zeros(1, np.uint8), 1)
    return Reader(lambda data: load_humanoid_bytes(data, "fuzz.glb"), seeds, words, GLB)


def bones_reader() -> Reader:
    """`FILE.bones.json`."""
    from elbowroom.body.bone_mapping.file_nodes import FileNodes
    from elbowroom.body.bone_mapping.override import override_nodes, parse_override

    names = ("Hips", "Spine", "Hand", "Hand")
    nodes = FileNodes(names, np.arange(4) - 1, np.zeros((4, 3)))
    words = (b'"hips":', b"null", b'"Hand"', b"1e9", b"{", b"[[[[", b'"leftHand":3')
    seeds = (b'{"hips": "Hips", "spine": 1, "leftHand": null}', b'{"head": 3}')
    return Reader(lambda data: override_nodes(parse_override(data, "fuzz.bones.json"), nodes), seeds, words)


def bvh_reader() -> Reader:
    """BVH files, down to the motion in planning's terms."""
    from bvh_builder import BvhRecipe, random_motion, write_bvh
    from elbowroom.clips.files import parse_motion
    from elbowroom.clips.planning_motion import planning_motion

    motion = random_motion(np.random.default_rng(0), 4)
    recipes = (BvhRecipe(), BvhRecipe(unit=1.0, order="YZX", all_positions=True, crlf=True))
    words = (b"JOINT x {", b"End Site {", b"}", b"OFFSET 1e9 nan 0", b"CHANNELS 6", b"MOTION", b"Frames: 9999999", b"-")
    return Reader(
        lambda data: planning_motion(parse_motion(data, "fuzz.bvh").clip().motion),
        tuple(write_bvh(motion, recipe) for recipe in recipes),
        words,
    )


def animation_reader() -> Reader:
    """Animations in GLB and VRM animations."""
    from animation_builder import animated_glb
    from elbowroom.clips.files import parse_motion
    from elbowroom.clips.planning_motion import planning_motion

    words = (b'"count":1e9', b'"interpolation":"STEP"', b'"node":-1', b'"path":"rotation"', b"null", b"[[[[", b"1e308")

    def read(data: bytes) -> None:
        library = parse_motion(data, "fuzz.glb")
        for name in library.clips:
            planning_motion(library.clip(name).motion)

    return Reader(read, (animated_glb(), animated_glb(vrma=True), animated_glb(mode="CUBICSPLINE")), words, GLB)


def _take() -> "Take":
    """A small motion of all bones, by their names."""
    from bvh_builder import BONES, BvhRecipe, random_motion, write_bvh
    from elbowroom.formats.bvh import parse_bvh

    motion = random_motion(np.random.default_rng(0), 4)
    return parse_bvh(write_bvh(motion, BvhRecipe(unit=1.0, names=dict(zip(BONES, BONES, strict=True)))), "a.bvh").take()


def _clips(name: str) -> Callable[[bytes], object]:
    """Reads a motion file, down to the motion in planning's terms."""
    from elbowroom.clips.files import parse_motion
    from elbowroom.clips.planning_motion import planning_motion

    def read(data: bytes) -> None:
        library = parse_motion(data, name)
        for clip in library.clips:
            planning_motion(library.clip(clip).motion)

    return read


def usd_reader() -> Reader:
    """UsdSkel in USD as text."""
    from elbowroom.formats.usd.writing import write_usda

    placed = b"""(-1, 0.5, 0)
        float xformOp:rotateY.timeSamples = { 0: 3, 2: 90 }
        uniform token[] xformOpOrder = ["xformOp:translate", "!invert!xformOp:rotateY"]
"""
    good = write_usda(_take(), {}, 1.0)
    moved = good.replace(
        b'def Skeleton "skeleton"', b"double3 xformOp:translate = " + placed + b'def Skeleton "skeleton"'
    )
    words: tuple[bytes, ...] = (
        b'def Xform "a" {',
        b"}",
        b"(",
        b"[[[[",
        b'"""',
        b"@@@",
        b"<",
        b"/*",
        b"1e999",
        b"nan",
        b".timeSamples = { 0: [",
    )
    words += (b'["xformOp:transform"]', b"rel skel:animationSource = </a>", b"metersPerUnit = 0", b'upAxis = "X"')
    return Reader(_clips("fuzz.usda"), (good, moved), words)


def hanim_motion_reader() -> Reader:
    """The interpolators of an H-Anim figure."""
    from hanim_builder import HanimRecipe
    from hanim_mover import build_moving

    turns = np.array([[0.0, 1.0, 0.0, 0.5 * frame] for frame in range(5)])
    moves = {("", "translation"): turns[:, 1:], ("hips", "rotation"): turns, ("leftUpperArm", "rotation"): turns}
    words: tuple[bytes, ...] = (
        b'keyValue="0 1 0 1e9"',
        b'key="1 0"',
        b'cycleInterval="0"',
        b'<ROUTE fromNode="Clock" fromField="fraction_changed" toNode="Clock" toField="set_fraction"/>',
        b"set_translation",
        b'DEF="Figure"',
        b'scale="0 0 0"',
        b'rotation="0 0 0 nan"',
    )
    seeds = tuple(build_moving(HanimRecipe(encoding, points=4), moves) for encoding in ("xml", "classic"))
    return Reader(_clips("fuzz.x3d"), seeds, words)


def hanim_reader(encoding: str, words: tuple[bytes, ...]) -> Reader:
    """H-Anim humanoids in one of the encodings of X3D."""
    from elbowroom.body.loading.avatar_file import load_humanoid_bytes
    from hanim_builder import SOLIDS, HanimRecipe, build_hanim

    version = "1.1" if encoding == "vrml" else "2.0"
    recipes = (
        HanimRecipe(encoding, version, points=4),
        HanimRecipe(encoding, "2.0", skinned=True, points=4, prefix="Joe_", displaced=True),
    )
    seeds = (*map(build_hanim, recipes), build_hanim(HanimRecipe(encoding, points=0, extras=SOLIDS)))
    return Reader(lambda data: load_humanoid_bytes(data, "fuzz.wrl"), seeds, words)


def xml_reader() -> Reader:
    """X3D in XML."""
    words: tuple[bytes, ...] = (
        b"<Group>",
        b"</Group>",
        b'<Shape USE="Figure"/>',
        b'<ProtoInstance name="P"/>',
        b"<!ENTITY a 'aa'>",
    )
    words += (b'containerField="skeleton"', b'center="nan 1 2"', b"<Transform DEF='a'><Group USE='a'/>", b"<![CDATA[")
    return hanim_reader("xml", words)


def classic_reader() -> Reader:
    """X3D in the Classic encoding."""
    words: tuple[bytes, ...] = (
        b"Group { children [",
        b"]",
        b"}",
        b"USE Figure",
        b"PROTO P [ ] {",
        b"P { }",
        b"IS center",
        b"NULL",
    )
    words += (b"EXTERNPROTO Q [ ] [ ", b'"', b"#", b"center 1e999 0 0", b"[ 0x7fffffff", b"META", b"ROUTE a.b TO c.d")
    return hanim_reader("classic", words)


def vrml_reader() -> Reader:
    """VRML97, with the PROTOs of H-Anim 1.1."""
    words: tuple[bytes, ...] = (
        b"Transform { children [",
        b"PROTO P [ field MFNode c [ ] ] { Group { children IS c } }",
        b"P { c [",
    )
    words += (
        b"DEF A Group { children [ USE A ] }",
        b"eventIn SFBool a",
        b"]",
        b"}",
        b"{",
        b"[",
        b'"\\',
        b"Joint {",
        b"#",
    )
    return hanim_reader("vrml", words)


def packed_reader() -> Reader:
    """The three packed with gzip."""
    from elbowroom.body.loading.avatar_file import load_humanoid_bytes
    from hanim_builder import HanimRecipe, build_hanim

    encodings = ("xml", "classic", "vrml")
    seeds = tuple(build_hanim(HanimRecipe(encoding, points=4, packed=True)) for encoding in encodings)
    words = (b"\x1f\x8b\x08\x00", b"\x00" * 9)
    return Reader(lambda data: load_humanoid_bytes(data, "fuzz.wrz"), seeds, words, GZIP)


def scene_reader() -> Reader:
    """Scene files."""
    from elbowroom.world.json_place import parse_json
    from elbowroom.world.scene import Scene

    seeds = tuple(json.dumps(Scene.load(name).to_dict()).encode() for name in ("empty", "a", "traffic"))
    words = (b'"size":[1e9,1,1]', b"null", b"[[[[", b'"type":"box"', b"1e308", b'"rotation":[0,0,0,0]', b"{", b'"x":')

    def read(data: bytes) -> None:
        Scene.from_dict(parse_json(data.decode("utf-8", "replace"), "fuzz.json"), "fuzz.json")

    return Reader(read, seeds, words)


def message_reader() -> Reader:
    """What a client sends over a live session."""
    from elbowroom.server.schema.commands import ClockMessage, Configure, Input, Overlays, Ping
    from elbowroom.server.wire.codec import decode_client, encode

    configure, clock = Configure("a", queue_size=5), ClockMessage(steps=2)
    messages = (Input(3, 1.0, direction=0.5), configure, clock, Overlays(), Ping(1.0))
    words = (b"null", b"1e999", b"[[[[", b'"type":"reset"', b"-1", b"true", b"9" * 400, b"NaN", b"{")
    seeds = tuple(encode(message).encode() for message in messages)
    return Reader(lambda data: decode_client(data.decode("utf-8", "replace")), seeds, words)


def recording_reader() -> Reader:
    """Recordings, to their last step."""
    from elbowroom.body.fitting.proportions import proportional_humanoid
    from elbowroom.control.controller import Controller
    from elbowroom.control.recordings.recording import Recorder, Recording, RecordingHeader
    from elbowroom.planning.command import Command
    from elbowroom.world.scene import Scene

    file = Path(tempfile.mkdtemp()) / "fuzz.elbow"
    controller = Controller(proportional_humanoid(1.72), Scene.load("empty"))
    with Recorder(file, controller) as recorder:
        for _ in range(5):
            recorder.append(controller.step(Command(), 0.01), 0.01)
    header = len(RecordingHeader.of(controller).to_json())

    def read(data: bytes) -> None:
        file.write_bytes(data)
        Recording(file).steps()

    start = file.read_bytes().index(b"{")
    good = file.read_bytes()
    whole = Container(
        lambda data: [data[start : start + header], data[start + header + 4 :]],
        lambda parts: (
            good[: start - 4]
            + struct.pack("<I", len(parts[0]))
            + parts[0]
            + struct.pack("<I", zlib.crc32(parts[0]))
            + parts[1]
        ),
    )
    words = (b"CHNK", b"DONE", b"null", b"[[[[", b'"seed":-1', b"1e999", b'"queue_size":1e9')
    return Reader(read, (good,), words, whole)


def place_reader() -> Reader:
    """Models of places in GLB, down to the scene and what a page shows of it."""
    from place_builder import glb

    rooms = {
        "Floor": ((0, -0.1, 0), (4, 0.2, 4)),
        "Wall": ((1.5, 1, 0), (0.2, 2, 4)),
        "Step": ((0, 0.1, 1), (1, 0.2, 1)),
    }
    words = (
        b'"matrix":[1e9]',
        b'"scale":[0,0,0]',
        b'"children":[0]',
        b"null",
        b'"count":1e9',
        b"[[[[",
        b'"mode":5',
        b"1e999",
        b'"materials":{}',
        b'"primitives":[0]',
        b'"name":0',
    )
    return Reader(_place("fuzz.glb"), (glb(rooms), glb(rooms, z_up=True)), words, GLB)


def loose_reader() -> Reader:
    """Models of places in OBJ, STL and PLY."""
    import io

    import trimesh

    floor = trimesh.creation.box(extents=(3.0, 0.2, 3.0))
    seeds = []
    for kind in ("obj", "stl", "ply", "stl_ascii"):
        written = floor.export(file_type=kind)
        seeds.append(written.encode() if isinstance(written, str) else bytes(written))
    text = io.BytesIO()
    floor.export(text, file_type="ply", encoding="ascii")
    seeds.append(text.getvalue())
    words: tuple[bytes, ...] = (
        b"f 1 2 99999999\n",
        b"v nan 1e999 0\n",
        b"g x\n",
        b"mtllib ../x\n",
        b"usemtl x\n",
        b"facet normal",
        b"endloop",
    )
    words += (b"element vertex 4000000000\n", b"property list uchar int x\n", b"end_header\n", b"f -1 -2 -3\n")
    return Reader(_place("fuzz"), tuple(seeds), words)


def world_reader() -> Reader:
    """Worlds of X3D and VRML97 as places: primitives, face sets, extrusions, elevation grids."""
    shapes = (
        "Transform { translation 0 -0.1 0 children Shape { geometry Box { size 6 0.2 6 } } } "
        "DEF A Transform { translation 1 0.5 1 rotation 0 1 0 0.4 children "
        "[ Shape { geometry Cylinder { height 1 } } ] } "
        "Transform { translation -2 0 0 children USE A } Switch { whichChoice 0 choice Shape { geometry Cone { } } } "
        "LOD { level [ Shape { geometry Sphere { radius 0.3 } } Group { } ] range 5 } "
        "Shape { geometry ElevationGrid { xDimension 3 zDimension 2 height [ 0 0 .1 0 .1 0 ] } } "
        "Shape { geometry Extrusion { spine [ 0 0 0, 0 1 0 ] } } "
        "Shape { geometry IndexedFaceSet { coordIndex [ 0 2 1 -1 ] "
        "coord Coordinate { point [ 0 0 0, 1 0 0, 1 0 1 ] } } }"
    )
    seeds = (f"#VRML V2.0 utf8\n{shapes}\n".encode(), f"#X3D V3.3 utf8\nPROFILE Full\n{shapes}\n".encode())
    words: tuple[bytes, ...] = (
        b"USE A",
        b'Inline { url "../x.wrl" }',
        b"xDimension 99999999",
        b"scale 0 0 1e38",
        b"PROTO P [ ] {",
        b"}",
        b"]",
    )
    words += (
        b"crossSection [",
        b"spine [ 0 0 0 ]",
        b"coordIndex [ 0 1 99999 -1",
        b"creaseAngle nan",
        b"size -1 0 1",
        b"NULL",
    )
    # Copies make worlds of 4,000 parts and 900,000 triangles. So long may the server's process read, too.
    return Reader(_place("fuzz.wrl"), seeds, words, longest=20.0)


def _place(name: str) -> Callable[[bytes], object]:
    from elbowroom.world.places.place_scene import place_scene
    from elbowroom.world.places.reading import parse_place
    from elbowroom.world.places.shown import shown_glb

    def read(data: bytes) -> None:
        place = parse_place(data, name)
        scene = place_scene(place)
        assert scene.place is not None
        shown_glb(place, scene.place.options.ground or 0.0)
        scene.to_dict()

    return read


def dataset_reader() -> Reader:
    """Specs of datasets."""
    from elbowroom.dataset.spec import DatasetSpec
    from elbowroom.world.json_place import parse_json

    seeds = ((Path(__file__).parents[1] / "examples" / "dataset.json").read_bytes(),)
    words: tuple[bytes, ...] = (
        b"null",
        b"[[[[",
        b"1e308",
        b'"scenes":[]',
        b"-1",
        b'"seed":1e99',
        b"{",
        b'"../x"',
        b'"weight":nan',
    )

    def read(data: bytes) -> None:
        DatasetSpec.of(parse_json(data.decode("utf-8", "replace"), "fuzz.json"))

    return Reader(read, seeds, words)


READERS: dict[str, Callable[[], Reader]] = {
    "glb": glb_reader,
    "compressed": compressed_reader,
    "bones": bones_reader,
    "bvh": bvh_reader,
    "animation": animation_reader,
    "usd": usd_reader,
    "x3d-motion": hanim_motion_reader,
    "x3d-xml": xml_reader,
    "x3d-classic": classic_reader,
    "vrml97": vrml_reader,
    "x3d-gzip": packed_reader,
    "place": place_reader,
    "triangles": loose_reader,
    "world": world_reader,
    "scene": scene_reader,
    "dataset": dataset_reader,
    "message": message_reader,
    "recording": recording_reader,
}
