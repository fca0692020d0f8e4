"""Throws damaged files at the readers: each must answer with a result or one line, soon, and with bounded memory.

Call: python tools/fuzz_readers.py [READER ...] [--inputs 20000] [--seed 1] [--keep FOLDER]

Each reader runs in a process of its own, bounded as the server bounds its readers; should an input end that process,
it is told and the next ones go on in another. A reader of one's own is registered in `READERS`: how it reads bytes, a
few good files, and pieces of its grammar. The same seed throws the same files. Exit code 1 if any input broke a
promise; `--keep` saves those inputs.
"""

import argparse
import gzip
import json
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import NoReturn

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from elbowroom.server.apart.bounds import Bounds, keep_to
from fuzzing import Container, Reader, answer, damaged

LONGEST = 2.0  # seconds of processor time that one input may take
_GIVEN_UP = 20.0  # seconds of it after which it is stopped
MEMORY = 2**30  # bytes that the process of a reader may have


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
    from elbowroom.body.loading import load_humanoid_bytes

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
    from elbowroom.body.loading import load_humanoid_bytes
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


def hanim_reader(encoding: str, words: tuple[bytes, ...]) -> Reader:
    """H-Anim humanoids in one of the encodings of X3D."""
    from elbowroom.body.loading import load_humanoid_bytes
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
    from elbowroom.body.loading import load_humanoid_bytes
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
    from elbowroom.server.codec import decode_client, encode
    from elbowroom.server.schema.commands import ClockMessage, Configure, Input, Overlays, Ping

    configure, clock = Configure("a", queue_size=5), ClockMessage(steps=2)
    messages = (Input(3, 1.0, direction=0.5), configure, clock, Overlays(), Ping(1.0))
    words = (b"null", b"1e999", b"[[[[", b'"type":"reset"', b"-1", b"true", b"9" * 400, b"NaN", b"{")
    seeds = tuple(encode(message).encode() for message in messages)
    return Reader(lambda data: decode_client(data.decode("utf-8", "replace")), seeds, words)


def recording_reader() -> Reader:
    """Recordings, to their last step."""
    from elbowroom.body.proportions import proportional_humanoid
    from elbowroom.control.controller import Controller
    from elbowroom.control.recording import Recorder, Recording, RecordingHeader
    from elbowroom.planning.command import Command
    from elbowroom.world.scene import Scene

    file = Path(tempfile.mkdtemp()) / "fuzz.elbow"
    controller = Controller(proportional_humanoid(1.72), Scene.load("empty"))
    with Recorder(file, controller) as recorder:
        for _ in range(5):
            recorder.append(Command(), 0.01, controller.step(Command(), 0.01))
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


READERS: dict[str, Callable[[], Reader]] = {
    "glb": glb_reader,
    "compressed": compressed_reader,
    "bones": bones_reader,
    "bvh": bvh_reader,
    "animation": animation_reader,
    "x3d-xml": xml_reader,
    "x3d-classic": classic_reader,
    "vrml97": vrml_reader,
    "x3d-gzip": packed_reader,
    "scene": scene_reader,
    "message": message_reader,
    "recording": recording_reader,
}


def run(name: str, inputs: range, seed: int, keep: Path | None) -> bool:
    """Fuzz one reader in this process and print a line of what it answered; True if it kept every promise.

    Before each input its number is printed, after an @.
    """
    reader = READERS[name]()
    for good in reader.seeds:
        answer(reader, good)  # compiled and warm; its time does not count
    keep_to(Bounds(memory=MEMORY, processor=10**6))
    answers: Counter[str] = Counter()
    slowest = 0.0
    for number in inputs:
        print(f"@{number}", flush=True)
        data = damaged(reader, np.random.default_rng([seed, number]))
        start = time.process_time()
        result = _watched(reader, data)
        took = time.process_time() - start
        slowest = max(slowest, took)
        if took > LONGEST:
            result = f"took {took:.1f} s"
        answers[result if result in {"read", "refused"} else "broken"] += 1
        if result not in {"read", "refused"}:
            _tell(name, number, seed, result, keep)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{name}: {len(inputs)} inputs, {answers['read']} read, {answers['refused']} refused, "
        f"{answers['broken']} broken; slowest {slowest:.2f} s, process peak {peak:.0f} MB",
        flush=True,
    )
    return answers["broken"] == 0


def run_apart(name: str, inputs: int, seed: int, keep: Path | None) -> bool:
    """The same in a process of its own, and in another one where an input has ended it."""
    whole, number = True, -1
    while number + 1 < inputs:
        command = [sys.executable, __file__, name, "--inputs", str(inputs), "--seed", str(seed)]
        command += ["--inside", str(number + 1), *(["--keep", str(keep)] if keep else [])]
        number = -1
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            for line in process.stdout:
                if line.startswith("@"):
                    number = int(line[1:])
                else:
                    print(line, end="", flush=True)
        if process.returncode in (0, 1) and (number + 1 == inputs):
            return whole and process.returncode == 0
        whole = False
        if number < 0:
            print(f"{name}: does not start (exit code {process.returncode})", flush=True)
            return False
        _tell(name, number, seed, f"ended its reader with {process.returncode}", None)
    return whole


def _tell(name: str, number: int, seed: int, result: str, keep: Path | None) -> None:
    print(f"{name}: input {number} of seed {seed}: {result}", flush=True)
    if keep is not None:
        keep.mkdir(parents=True, exist_ok=True)
        data = damaged(READERS[name](), np.random.default_rng([seed, number]))
        (keep / f"{name}-{seed}-{number}").write_bytes(data)


def _watched(reader: Reader, data: bytes) -> str:
    signal.signal(signal.SIGPROF, _stop)
    signal.setitimer(signal.ITIMER_PROF, _GIVEN_UP)
    try:
        return answer(reader, data)
    except Exception as error:
        return f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def _stop(_number: int, _frame: FrameType | None) -> NoReturn:
    raise TimeoutError(f"stopped after {_GIVEN_UP:.0f} s of processor time")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("readers", nargs="*", metavar="READER", help=f"of {', '.join(READERS)}; all if none is named")
    parser.add_argument("--inputs", type=int, default=20_000, help="of each reader")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for the inputs that broke a promise")
    parser.add_argument("--inside", type=int, metavar="FIRST", help="in this process, from this input on")
    options = parser.parse_args()
    names = options.readers or list(READERS)
    unknown = sorted(set(names) - READERS.keys())
    if unknown:
        parser.error(f"no reader {', '.join(unknown)}; there are {', '.join(READERS)}")
    if options.inside is not None:
        kept = [run(name, range(options.inside, options.inputs), options.seed, options.keep) for name in names]
    else:
        kept = [run_apart(name, options.inputs, options.seed, options.keep) for name in names]
    sys.exit(0 if all(kept) else 1)


if __name__ == "__main__":
    main()
