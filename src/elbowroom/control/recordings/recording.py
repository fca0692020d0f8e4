"""Recordings: what was asked and what was shown, step by step, in a file that survives a crash.

A `.elbow` file is the line `ELBOWROOM RECORDING 8`, a header, chunks and an end. Header: its length (uint32), UTF-8
JSON of a `RecordingHeader`, CRC-32 of the JSON. Chunk: `CHNK`, number of steps, length of the zlib data, CRC-32 of that
data (uint32 each), the data: `STEP` records. Where things were pushed, a chunk `HAND` of `THING` records stands before
that of their steps; where a way was walked along, a chunk `WAYS` of `WAY` records. End: `DONE`, number of all steps, 0,
CRC-32 of all chunks' data. All numbers are little-endian. A file is only ever appended to, so one that was cut off is
good up to its last whole chunk.

Older files are read too: in those of the format 7, hips were carried as they were planned; in those of the format 6,
feet followed from the root; in those of the format 5, with 7
numbers of the root, all ground was level; in those of the format 4 nothing was pushed; in those of the format 3, 14
numbers of `q` wide, the head followed the waist; those of the format 2 have no end; and in those of the format 1, 13
wide, nobody lowered the pelvis.
"""

import hashlib
import json
import platform
import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numba
import numpy as np
from numpy.typing import NDArray

from elbowroom import __version__
from elbowroom.body.dof import DOF, LOWERING, DofGroup, followed
from elbowroom.body.root import CARRIAGE, FOOT, HEIGHT, ROOT_STATE, TOLD, RootState, as_told, told
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame, Phase
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.control.recordings.recorded_things import THING, Seen, ThingLog, Things, seen_now
from elbowroom.control.recordings.recorded_ways import WAY, WayLog, Ways
from elbowroom.control.recordings.walked_scene import SceneClock, walked_scene
from elbowroom.control.settings import ControlSettings
from elbowroom.errors import InputError, in_a_line
from elbowroom.planning.command import Command
from elbowroom.planning.root.line.way_ahead import Corners
from elbowroom.world.scene import Scene

MAGIC = b"ELBOWROOM RECORDING 8\n"
_MAGIC_7 = b"ELBOWROOM RECORDING 7\n"
_MAGIC_6 = b"ELBOWROOM RECORDING 6\n"
_MAGIC_5 = b"ELBOWROOM RECORDING 5\n"
_MAGIC_4 = b"ELBOWROOM RECORDING 4\n"
_MAGIC_3 = b"ELBOWROOM RECORDING 3\n"
_MAGIC_2 = b"ELBOWROOM RECORDING 2\n"
_MAGIC_1 = b"ELBOWROOM RECORDING 1\n"
STEPS_PER_CHUNK = 60
MAX_HEADER_BYTES = 32 * 2**20
MAX_CHUNK_STEPS = 4096
MOST_ROWS = 10_000_000  # of steps and of what is told beside them: two days, at 60 a second
MAX_CHUNK_ROWS = 65_536  # of what is told beside the steps
_CHUNK_MARK, _HAND_MARK, _WAYS_MARK, _END_MARK = b"CHNK", b"HAND", b"WAYS", b"DONE"
_BESIDE = {_HAND_MARK: THING, _WAYS_MARK: WAY}
_CHUNK_HEAD = struct.Struct("<4sIII")
_COUNT = struct.Struct("<I")

STEP = np.dtype(
    [
        ("forward", "<f8"),
        ("strafe", "<f8"),
        ("turn", "<f8"),
        ("direction", "<f8"),  # not a number where the command has none
        ("dt", "<f8"),
        ("q", "<f8", DOF),
        ("root", "<f8", TOLD),
        ("phase", "u1"),  # place in `Phase`
        ("flags", "u1"),
    ]
)
_ROOT_SIZES = {MAGIC: TOLD, _MAGIC_7: TOLD - CARRIAGE, _MAGIC_6: ROOT_STATE}  # numbers of a root; earlier HEIGHT
_Q_3 = np.arange(DofGroup.HEAD.at.start)  # the places of older files' numbers in `q`
_Q_1 = np.delete(_Q_3, LOWERING)
_PLACES = {
    **dict.fromkeys((MAGIC, _MAGIC_7, _MAGIC_6, _MAGIC_5, _MAGIC_4), np.arange(DOF)),
    _MAGIC_3: _Q_3,
    _MAGIC_2: _Q_3,
    _MAGIC_1: _Q_1,
}
RUN, STUCK, TOUCHING, ASSIST, RESTART = 1, 2, 4, 8, 16  # RESTART: `Controller.reset` was called before this step
LED, LEVEL = 32, 64  # who goes on is led to a place; who stays on the level may not climb
_PHASES = tuple(Phase)
_ONE_PLACE = 1e-3  # metres: nobody's feet are as near to each other in every step
_SAID = 200  # characters of what a header says that are repeated in a message

Steps = NDArray[np.void]


@dataclass(frozen=True)
class RecordingHeader:
    """What a run depends on, besides the commands."""

    version: str  # of elbowroom
    scene: dict[str, Any]
    avatar: AvatarReference
    settings: ControlSettings
    start: RootState
    machine: dict[str, str]  # what the last bits of floating-point results may depend on
    motions: MotionSet = STOCK
    live: bool = False  # plans came when they were ready: computed again, they would come at other moments

    @classmethod
    def of(cls, controller: Controller) -> "RecordingHeader":
        """The header for a run of this controller."""
        return cls(
            version=__version__,
            scene=controller.scene.to_dict(),
            avatar=AvatarReference.of(controller.humanoid),
            settings=controller.settings,
            start=controller.start,
            machine=this_machine(),
            motions=controller.motions,
        )

    def to_json(self) -> bytes:
        """The header as JSON text."""
        document = asdict(self) | {"start": list(self.start), "motions": self.motions.to_dict()}
        return json.dumps(document, separators=(",", ":")).encode()

    @classmethod
    def from_json(cls, data: bytes) -> "RecordingHeader":
        """Read what `to_json` wrote; raises ValueError, KeyError or TypeError where it is something else."""
        document = json.loads(data)
        motions = document.get("motions")
        return cls(
            version=str(document["version"]),
            scene=dict(document["scene"]),
            avatar=AvatarReference(**document["avatar"]),
            settings=ControlSettings(**document["settings"]),
            start=RootState(*(float(value) for value in document["start"])),
            machine={str(key): str(value) for key, value in document["machine"].items()},
            motions=STOCK if motions is None else MotionSet.from_dict(motions, "motions"),
            live=bool(document.get("live", False)),
        )


def this_machine() -> dict[str, str]:
    """The processor that kernels are compiled for and what compiles them: by these, runs may differ in the last bit."""
    from llvmlite.binding import get_host_cpu_name

    config: Any = numba.config  # as jit has left it: what kernels are compiled for
    features = hashlib.sha256(str(config.CPU_FEATURES).encode()).hexdigest()[:8]
    return {
        "processor": str(config.CPU_NAME or get_host_cpu_name()),
        "processor features": features,
        "system": platform.system(),
        "numba": numba.__version__,
        "numpy": np.__version__,
    }


class StepWriter:
    """Appends the steps of a run to an open file."""

    def __init__(self, file: BinaryIO, controller: Controller, told: RecordingHeader | None = None) -> None:
        """`told` is the header, by default that of the controller."""
        self._file = file
        self._pending: list[tuple[Any, ...]] = []
        self._written, self._crc = 0, 0  # steps in all chunks, and of their data
        self._controller, self._time = controller, 0.0  # of the frame before
        self._things, self._ways = ThingLog(), WayLog()
        header = (told or RecordingHeader.of(controller)).to_json()
        self._file.write(MAGIC + _COUNT.pack(len(header)) + header + _COUNT.pack(zlib.crc32(header)))
        self._file.flush()

    @property
    def steps(self) -> int:
        """How many steps there are."""
        return self._written + len(self._pending)

    def append(self, frame: Frame, dt: float) -> None:
        """Keep the step of `dt` seconds that the controller has just made, by the frame that it gave for it."""
        self.append_later(frame, dt, self._controller.assist, seen_now(self._controller))

    def append_later(self, frame: Frame, dt: float, assist: bool, things: Seen) -> None:
        """The same of a step since which others may have been made: with the assistance and the `things` it had.

        A frame that is earlier than the one before is the first one after the controller was put back to its start.
        """
        command, restart, self._time = frame.command, frame.time < self._time, frame.time
        flags = (
            RUN * command.run | STUCK * frame.stuck | TOUCHING * frame.touching | ASSIST * assist | RESTART * restart
        ) | (LED * command.led | LEVEL * (not command.may_climb))
        direction = np.nan if command.direction is None else command.direction
        wish = (command.forward, command.strafe, command.turn, direction, dt)
        root = told(frame.root)  # without feet where it was not a controller that made it
        self._things.note(self.steps, things)
        self._ways.note(self.steps, command)
        self._pending.append((*wish, frame.q, root, _PHASES.index(frame.phase), flags))
        if len(self._pending) >= STEPS_PER_CHUNK:
            self.flush()

    def flush(self) -> None:
        """Write what is pending as a chunk, so that it survives whatever comes."""
        if not self._pending:
            return
        steps = np.array(self._pending, dtype=STEP)
        for mark, rows in ((_HAND_MARK, self._things.taken()), (_WAYS_MARK, self._ways.taken())):
            if len(rows):
                self._write_chunk(mark, rows)
        self._write_chunk(_CHUNK_MARK, steps)
        self._file.flush()
        self._written += len(steps)
        self._pending.clear()

    def _write_chunk(self, mark: bytes, records: NDArray[np.void]) -> None:
        data = zlib.compress(records.tobytes(), 6)
        self._file.write(_CHUNK_HEAD.pack(mark, len(records), len(data), zlib.crc32(data)) + data)
        self._crc = zlib.crc32(data, self._crc)

    def end(self) -> bytes:
        """Write what is pending; the end that makes the file whole as far as it goes now."""
        self.flush()
        return _CHUNK_HEAD.pack(_END_MARK, self._written, 0, self._crc)


class Recorder(StepWriter):
    """Appends the steps of a run to a file of its own; a context manager.

    It replaces a recording. Raises `InputError` where the path holds another kind of file, or cannot be written.
    """

    def __init__(self, path: str | Path, controller: Controller) -> None:
        self.path = Path(path)  # of the recording
        try:
            if self.path.exists() and not is_recording(self.path):
                raise InputError(f"{self.path}: exists and is no recording; choose another name or remove it")
            super().__init__(self.path.open("wb"), controller)
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written ({error.strerror})") from None

    def close(self) -> None:
        """Write what is pending and the end, and close the file."""
        if not self._file.closed:
            self._file.write(self.end())
            self._file.close()

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def is_recording(path: Path) -> bool:
    """Whether the file begins as a recording does; an empty file may become one."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) in (*_PLACES, b"")


class Recording:
    """A recording open for reading: its header, and its steps chunk by chunk.

    Raises `InputError` where the file is missing, no recording, or its header is damaged.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)  # of the file
        self.note: str | None = None  # after reading the steps: why they end before the file does
        self._beside: dict[bytes, list[NDArray[np.void]]] = {}  # rows told beside the steps that are read
        try:
            with self.path.open("rb") as file:
                self.header = self._read_header(file)  # who walked, where, and as what
                self._steps_at = file.tell()
        except OSError as error:
            raise InputError(f"{self.path}: cannot be read ({error.strerror})") from None

    def _read_header(self, file: BinaryIO) -> RecordingHeader:
        magic = file.read(len(MAGIC))
        self._places = _PLACES.get(magic, np.arange(0))
        self._has_end = magic in (MAGIC, _MAGIC_7, _MAGIC_6, _MAGIC_5, _MAGIC_4, _MAGIC_3)
        self.root_size = _ROOT_SIZES.get(magic, HEIGHT)
        if not len(self._places):
            raise InputError(_not_read_here(self.path, magic))
        size = file.read(_COUNT.size)
        length = _COUNT.unpack(size)[0] if len(size) == _COUNT.size else 0
        if not 0 < length <= MAX_HEADER_BYTES:
            raise InputError(f"{self.path}: header of {length} bytes, allowed are 1 to {MAX_HEADER_BYTES}")
        data, crc = file.read(length), file.read(_COUNT.size)
        if len(data) < length or len(crc) < _COUNT.size or _COUNT.unpack(crc)[0] != zlib.crc32(data):
            raise InputError(f"{self.path}: the header is damaged or cut off")
        try:
            return RecordingHeader.from_json(data)
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            why = in_a_line(error, _SAID)
            raise InputError(f"{self.path}: the header does not describe a run ({why})") from None

    def chunks(self) -> Iterator[Steps]:
        """Arrays of `STEP` records in order; ends at the last whole chunk and then says in `note` what is missing."""
        self.note, self._beside = None, {mark: [np.empty(0, row)] for mark, row in _BESIDE.items()}
        stored = _stored(len(self._places), self.root_size)
        count, rows, crc = 0, 0, 0
        with self.path.open("rb") as file:
            file.seek(self._steps_at)
            while head := file.read(_CHUNK_HEAD.size):
                if self._has_end and head[:4] == _END_MARK:
                    self.note = _end_note(head, file, count, crc)
                    return
                found = _read_chunk(head, file, _BESIDE.get(head[:4], stored))
                if found is None:
                    self.note = f"the file was cut off or is damaged: what follows step {count} is missing"
                    return
                steps, data = found
                crc = zlib.crc32(data, crc)
                rows += len(steps)
                if rows > MOST_ROWS:
                    self.note = f"only the first {count} steps are read: more would not fit into memory"
                    return
                if head[:4] in _BESIDE:
                    self._beside[head[:4]].append(steps)
                    continue
                count += len(steps)
                yield steps if stored == STEP else _completed(steps, self._places)
        if self._has_end:
            self.note = f"the file ends without its end mark: what follows step {count} is missing"

    @property
    def things(self) -> Things:
        """What was pushed in the steps that are read."""
        return self._told_beside(_HAND_MARK)

    @property
    def ways(self) -> Ways:
        """The ways that were walked along in them."""
        return self._told_beside(_WAYS_MARK)

    def _told_beside(self, mark: bytes) -> NDArray[np.void]:
        parts = self._beside.get(mark, [np.empty(0, _BESIDE[mark])])
        if len(parts) > 1:
            parts[:] = [np.concatenate(parts)]
        return parts[0]

    def steps(self) -> Steps:
        """All steps in one array."""
        return np.concatenate([np.empty(0, STEP), *self.chunks()])

    def scene(self) -> Scene:
        """The scene as it was while this was recorded: what was pushed moves as it did then; raises `InputError`."""
        scene, clock = Scene.from_dict(self.header.scene, str(self.path)), self.clock(self.steps())
        return walked_scene(scene, clock, self.things)

    def clock(self, steps: Steps) -> SceneClock:
        """The time of `scene` at all steps, which were read just before."""
        return SceneClock.of(np.asarray(steps["dt"], np.float64), (steps["flags"] & RESTART) != 0, self.things)


def roots_of(steps: Steps) -> NDArray[np.float64]:
    """Root states of `STEP` records with feet and carriage (N, SHOWN), or (N, ROOT_STATE) where they have no feet."""
    roots = as_told(np.ascontiguousarray(steps["root"], np.float64).reshape(-1, TOLD))
    return roots if _tell_of_feet(roots) else np.ascontiguousarray(roots[:, :ROOT_STATE])


def _tell_of_feet(roots: NDArray[np.float64]) -> bool:
    """Whether root states (N, SHOWN) tell of feet: those that are not told both lie at the root's own place."""
    left, right = (roots[:, first : first + 2] for first in (ROOT_STATE, ROOT_STATE + FOOT))
    with np.errstate(all="ignore"):  # a file may say anything
        together = np.hypot(*(left - right).T) < _ONE_PLACE
    return not bool(together.all())


def _stored(width: int, root: int) -> np.dtype[np.void]:
    """`STEP` with so many numbers of `q` and of the root."""
    widths = {"q": width, "root": root}
    return np.dtype(
        [(name, "<f8", widths[name]) if name in widths else (name, STEP[name]) for name in STEP.names or ()]
    )


def _completed(old: Steps, places: NDArray[np.intp]) -> Steps:
    """Steps of an older format as `STEP` records; `places` are those of their numbers in `q`."""
    steps, first = np.zeros(len(old), STEP), DofGroup.ROOT.size
    for name in old.dtype.names or ():
        if name not in ("q", "root"):
            steps[name] = old[name]
    steps["root"][:, : old["root"].shape[1]] = old["root"]
    steps["q"][:, places] = old["q"]
    if len(places) < DOF:
        steps["q"][:, first:] = followed(steps["q"][:, first:])
    return steps


def _end_note(head: bytes, file: BinaryIO, count: int, crc: int) -> str | None:
    """What is wrong, if anything, at the end of a file of which so many steps with this checksum were read."""
    if len(head) < _CHUNK_HEAD.size:
        return f"the file was cut off in its last bytes: whether anything is missing after step {count} is not known"
    _, steps, _, told = _CHUNK_HEAD.unpack(head)
    if steps != count:
        return f"the file was changed: it holds {count} of {steps} steps"
    if told != crc:
        return f"the file was changed: its {count} steps are not those that were recorded"
    return "the file goes on after its end" if file.read(1) else None


def _not_read_here(path: Path, magic: bytes) -> str:
    """Why a file that begins like this is not read."""
    other = re.fullmatch(rb"ELBOWROOM RECORDING (\d)\n", magic)
    if other is None:
        return f"{path}: is no recording of this format ({MAGIC.decode().strip()})"
    return f"{path}: was recorded by another version of Elbowroom: its format is {int(other[1])}"


def _read_chunk(head: bytes, file: BinaryIO, stored: np.dtype[np.void]) -> tuple[Steps, bytes] | None:
    """The steps of a chunk and its data; None where it is not whole."""
    if len(head) < _CHUNK_HEAD.size:
        return None
    mark, count, length, crc = _CHUNK_HEAD.unpack(head)
    expected, most = count * stored.itemsize, MAX_CHUNK_ROWS if mark in _BESIDE else MAX_CHUNK_STEPS
    if mark not in (_CHUNK_MARK, *_BESIDE) or not 0 < count <= most or length > expected + 1024:
        return None
    data = file.read(length)
    if len(data) < length or zlib.crc32(data) != crc:
        return None
    inflater = zlib.decompressobj()
    try:
        raw = inflater.decompress(data, expected + 1)
    except zlib.error:
        return None
    return (np.frombuffer(raw, stored), data) if len(raw) == expected and inflater.eof else None


def command_of(step: Any, way: Corners = ()) -> Command:
    """The command of one `STEP` record, and of the way that it names."""
    direction = None if np.isnan(step["direction"]) else float(step["direction"])
    forward, strafe, turn = float(step["forward"]), float(step["strafe"]), float(step["turn"])
    run, led, level = (bool(step["flags"] & flag) for flag in (RUN, LED, LEVEL))
    return Command(forward, strafe, turn, direction, run, way, led, not level)
