"""BVH, the Biovision hierarchy: a skeleton with channels, and their values frame by frame.

The format has no standard; this follows what its writers agree on (M. Meredith & S. Maddock, "Motion Capture File
Formats Explained", University of Sheffield CS-01-11): rotations in degrees are applied in the order of the channels,
each in the axes that the one before has turned; a position channel takes the place of that component of the offset.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.nodes import MAX_DEPTH, NodeTree
from elbowroom.formats.takes import MAX_FRAMES, MAX_POSES, Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

MAX_BYTES = 32 * 2**20
_MAX_VALUES = 6_000_000  # numbers of motion
_BLOCK = 2**20  # characters of motion that are taken apart at once
_SPACE = re.compile(r"\s")
_MAX_HEAD = 2 * 2**20  # bytes of the hierarchy
_MAX_NODES = 2_000
_LARGEST = 1e6  # of an offset, a position or an angle
_SLOWEST, _FASTEST = 10.0, 1e-4  # seconds from frame to frame
_CHANNEL = re.compile(r"([XYZ])(POSITION|ROTATION)")
_MOTION = re.compile(rb"^[ \t]*MOTION[ \t]*\r?$", re.IGNORECASE | re.MULTILINE)
_FRAMES = re.compile(r"\s*FRAMES\s*:\s*(\S+)[^\S\n]*\n", re.IGNORECASE)
_FRAME_TIME = re.compile(r"\s*FRAME\s+TIME\s*:\s*(\S+)[^\S\n]*(?:\n|$)", re.IGNORECASE)
_NO_NAMES = ("}", "OFFSET", "CHANNELS")
_SHOWN = 40


@dataclass(frozen=True)
class Channel:
    """One column of the motion."""

    joint: int
    axis: int  # 0 X, 1 Y, 2 Z
    rotation: bool  # degrees; else a position


@dataclass(frozen=True, eq=False)
class Bvh:
    """A BVH file as it stands: joints in the order of the file, end sites among them (named "… end")."""

    name: str  # of the file
    joints: tuple[str, ...]
    parents: NDArray[np.int64]  # (n,) -1 for the root
    offsets: Floats  # (n, 3)
    channels: tuple[Channel, ...]
    frame_time: float  # seconds
    values: Floats  # (F, C)

    def tree(self) -> NodeTree:
        """The rest pose: all rotations zero."""
        count = len(self.joints)
        nothing = np.full(count, -1, dtype=np.int64)
        turns, ones = np.tile(quaternion.IDENTITY, (count, 1)), np.ones((count, 3))
        return NodeTree(self.joints, self.parents, np.arange(count), self.offsets.copy(), turns, ones, nothing, nothing)

    def take(self) -> Take:
        """The motion of all joints."""
        frames = len(self.values)
        rotations = np.tile(quaternion.IDENTITY, (frames, len(self.joints), 1))
        translations = np.tile(self.offsets, (frames, 1, 1))
        for column, channel in enumerate(self.channels):
            value = self.values[:, column]
            if channel.rotation:
                turn = quaternion.about_axis(channel.axis, np.deg2rad(value))
                rotations[:, channel.joint] = quaternion.multiply(rotations[:, channel.joint], turn)
            else:
                translations[:, channel.joint, channel.axis] = value
        return Take(Path(self.name).stem, self.tree(), self.frame_time, rotations, translations)


def is_bvh(data: bytes) -> bool:
    """Whether the bytes begin as a BVH file does."""
    return data[:256].lstrip(b"\xef\xbb\xbf \t\r\n").upper().startswith(b"HIERARCHY")


def parse_bvh(data: bytes, name: str) -> Bvh:
    """Read the bytes of a BVH file; raises `InputError` that names the line."""
    if len(data) > MAX_BYTES:
        raise InputError(f"{name} has {len(data) >> 20} MB: at most {MAX_BYTES >> 20} MB are read")
    if not is_bvh(data):
        shown = data[:20].decode("latin-1").split("\n")[0]
        raise InputError(f"{name}: line 1: {shown!r} where a BVH file begins with HIERARCHY")
    motion = _MOTION.search(data)
    head = data[: motion.start()] if motion else data
    if len(head) > _MAX_HEAD:
        raise InputError(f"{name}: the hierarchy has {len(head) >> 20} MB: at most {_MAX_HEAD >> 20} MB are read")
    hierarchy = _Hierarchy(head.decode("utf-8-sig", "replace").lstrip("\ufeff"), name)
    if motion is None:
        raise InputError(f"{name}: there is no MOTION after the hierarchy: the file was cut off, or is a skeleton only")
    first = data.count(b"\n", 0, motion.end()) + 1
    frame_time, values = _motion(
        data[motion.end() :].decode("latin-1"), first, len(hierarchy.names), len(hierarchy.channels), name
    )
    return Bvh(
        name,
        tuple(hierarchy.names),
        np.array(hierarchy.parents, dtype=np.int64),
        np.array(hierarchy.offsets).reshape(-1, 3),
        tuple(hierarchy.channels),
        frame_time,
        values,
    )


class _Hierarchy:
    """Reads HIERARCHY word by word; line breaks mean nothing to it."""

    def __init__(self, text: str, name: str) -> None:
        self.names: list[str] = []
        self.parents: list[int] = []
        self.offsets: list[list[float]] = []
        self.channels: list[Channel] = []
        self._name, self._line = name, 1
        self._words = _words(text)
        self._ahead: str | None = None
        self._next()  # HIERARCHY
        self._expect("ROOT", "the first joint")
        self._joints()
        if (word := self._next()) is not None:
            raise self._wrong(word, "MOTION (one ROOT is read)")

    def _joints(self) -> None:
        """The root and all below it; `above` are the joints whose braces are open."""
        above: list[int] = []
        self._open(above, self._joint_name())
        while above:
            word = self._next()
            kind = "" if word is None else word.upper()
            if kind == "}":
                above.pop()
            elif kind == "JOINT":
                self._open(above, self._joint_name())
            elif kind == "END":
                self._joint_name()
                self._open(above, f"{self.names[above[-1]]} end")
            elif kind == "OFFSET":
                self.offsets[above[-1]] = [self._number() for _ in range(3)]
            elif kind == "CHANNELS":
                self._read_channels(above[-1])
            else:
                raise self._wrong(word, f"OFFSET, CHANNELS, JOINT, End Site or }} in {self.names[above[-1]]!r}")

    def _open(self, above: list[int], name: str) -> None:
        if len(self.names) >= _MAX_NODES:
            raise InputError(f"{self._name}: line {self._line}: more than {_MAX_NODES} joints")
        if len(above) >= MAX_DEPTH:
            raise InputError(f"{self._name}: line {self._line}: the joints hang more than {MAX_DEPTH} deep")
        self.parents.append(above[-1] if above else -1)
        above.append(len(self.names))
        self.names.append(name)
        self.offsets.append([0.0, 0.0, 0.0])

    def _read_channels(self, joint: int) -> None:
        word = self._next()
        if word is None or not word.isdecimal() or len(word) > 2 or int(word) > 6:
            raise self._wrong(word, "the number of channels, 0 to 6")
        for _ in range(int(word)):
            found = self._next()
            match = _CHANNEL.fullmatch("" if found is None else found.upper())
            if match is None:
                raise self._wrong(found, f"one of {word} channels, Xposition to Zrotation")
            channel = Channel(joint, "XYZ".index(match[1]), match[2] == "ROTATION")
            if channel in self.channels[-6:]:
                raise self._wrong(found, "a channel that the joint does not have yet")
            self.channels.append(channel)

    def _joint_name(self) -> str:
        """The words up to the opening brace."""
        words: list[str] = []
        while (word := self._next()) != "{":
            if word is None or word.upper() in _NO_NAMES or len(words) > 16:
                raise self._wrong(word, "the joint's name and {")
            words.append(word)
        return " ".join(words)[:200]

    def _number(self) -> float:
        word = self._next()
        try:
            value = float(word or "")
        except ValueError:
            raise self._wrong(word, "a number") from None
        if not abs(value) <= _LARGEST:
            raise self._wrong(word, f"a number up to {_LARGEST:g}")
        return value

    def _expect(self, wanted: str, what: str) -> None:
        word = self._next()
        if word is None or word.upper() != wanted:
            raise self._wrong(word, f"{wanted}, {what}")

    def _next(self) -> str | None:
        line, word = next(self._words, (self._line, None))
        self._line = line
        return word

    def _wrong(self, word: str | None, allowed: str) -> InputError:
        if word is None:
            return InputError(f"{self._name}: line {self._line}: the hierarchy ends here, but a brace is not closed")
        shown = word if len(word) <= _SHOWN else word[:_SHOWN] + "..."
        return InputError(f"{self._name}: line {self._line}: {shown!r} where there must be {allowed}")


def _words(text: str) -> Iterator[tuple[int, str]]:
    """Every word with its line; braces are words of their own, and a line that begins with # or // is a remark."""
    for number, line in enumerate(text.split("\n"), start=1):
        if not line.lstrip().startswith(("#", "//")):
            for word in line.replace("{", " { ").replace("}", " } ").split():
                yield number, word


def _motion(text: str, line: int, joints: int, width: int, name: str) -> tuple[float, Floats]:
    """Frame time and values (F, C) of what follows the word MOTION on line `line`."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if text.startswith("\n"):
        text, line = text[1:], line + 1
    count = _FRAMES.match(text)
    if count is None:
        raise InputError(f"{name}: line {line}: after MOTION there must be 'Frames: <count>'")
    stated = line + text.count("\n", 0, count.start(1))
    frames = _frames(count[1], joints, width, f"{name}: line {stated}")
    step = _FRAME_TIME.match(text, count.end())
    if step is None:
        raise InputError(f"{name}: line {stated + 1}: after Frames there must be 'Frame Time: <seconds>'")
    seconds = _seconds(step[1])
    if seconds is None:
        place = f"{name}: line {line + text.count(chr(10), 0, step.start(1))}"
        limits = f"{_FASTEST:g} to {_SLOWEST:g} seconds"
        raise InputError(f"{place}: Frame Time: {step[1][:_SHOWN]!r} is not a number from {limits}")
    begin = line + text.count("\n", 0, step.end())
    values = _numbers(text, step.end(), begin, (frames + 1) * width, name)
    if len(values) == (frames + 1) * width and frames and not _first_odd_line(text[step.end() :], begin, width):
        frames += 1  # many writers count from 0
    if len(values) != frames * width:
        mend = _first_odd_line(text[step.end() :], begin, width)
        raise InputError(
            f"{name}: {mend}"
            if mend
            else f"{name}: line {stated}: Frames: {frames}, but {len(values) // max(width, 1)} follow: "
            "the file was cut off or edited"
        )
    return seconds, values.reshape(frames, width)


def _frames(word: str, joints: int, width: int, place: str) -> int:
    if not word.isdecimal() or len(word) > 9 or int(word) > MAX_FRAMES:
        raise InputError(f"{place}: Frames: {word[:_SHOWN]!r} is not a whole number up to {MAX_FRAMES}")
    frames = int(word)
    if frames * joints > MAX_POSES or frames * width > _MAX_VALUES:
        raise InputError(f"{place}: {frames} frames of {joints} joints: at most {MAX_POSES} joint poses are read")
    return frames


def _seconds(word: str) -> float | None:
    try:
        value = float(word)
    except ValueError:
        return None
    return value if math.isfinite(value) and _FASTEST <= value <= _SLOWEST else None


def _numbers(text: str, at: int, line: int, most: int, name: str) -> Floats:
    """The numbers of the motion lines from `at` on, block by block; few more than `most` are read."""
    blocks, found = [np.empty(0)], 0
    while at < len(text) and found <= most:
        border = _SPACE.search(text, at + _BLOCK)
        end = border.start() if border else len(text)
        words = text[at:end].split()
        try:
            values = np.fromiter(map(float, words), np.float64, len(words))
        except ValueError:
            values = np.array([np.nan])
        if not (np.abs(values) <= _LARGEST).all():
            raise _bad_number(text[at:end], line, name)
        blocks.append(values)
        found += len(values)
        line += text.count("\n", at, end)
        at = end
    return np.concatenate(blocks)


def _bad_number(text: str, line: int, name: str) -> InputError:
    """The error that names the first word of `text`, which begins on `line`, that is no number in range."""
    for number, row in enumerate(text.split("\n"), start=line):
        for word in row.split():
            try:
                good = abs(float(word)) <= _LARGEST
            except ValueError:
                good = False
            if not good:
                shown = word if len(word) <= _SHOWN else word[:_SHOWN] + "..."
                return InputError(f"{name}: line {number}: {shown!r} is not a number up to {_LARGEST:g}")
    return InputError(f"{name}: line {line}: the motion is not a table of numbers")


def _first_odd_line(text: str, line: int, width: int) -> str | None:
    """The first line with another count of numbers than a frame has."""
    for number, row in enumerate(text.split("\n"), start=line):
        count = len(row.split(maxsplit=width + 1))
        if count not in (0, width):
            more = f"more than {width}" if count > width else str(count)
            return f"line {number}: {more} numbers, where a frame has {width}, one for each channel of the joints"
    return None
