"""Damaged files made from good ones, and what a reader may answer to them: a result, or one line that says why not."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from elbowroom.errors import InputError

LONGEST_MESSAGE = 600

_NUMBER = re.compile(rb"\d+")
_NAME = re.compile(rb"[A-Za-z_]{2,40}")
_HARMLESS = b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-+ _"  # characters of any text
_HUGE = (b"0", b"-1", b"1e308", b"-1e309", b"nan", b"4294967295", b"99999999999999999999", b"0.0000001", b"1e-320")
_BOMB = 4096  # repeats of a piece that is nested or copied


@dataclass(frozen=True)
class Container:
    """A file format that wraps others and says how long they are, or what their checksum is.

    Damage to the whole file mostly stops at the wrapping; so every other input has a part damaged and wrapped anew.
    """

    unpack: Callable[[bytes], list[bytes]]
    pack: Callable[[list[bytes]], bytes]


@dataclass(frozen=True)
class Reader:
    """A reader under test."""

    read: Callable[[bytes], object]  # raises InputError, or returns what it read
    seeds: tuple[bytes, ...]  # good files, small ones first
    words: tuple[bytes, ...] = ()  # pieces of the grammar that are thrown in
    container: Container | None = None
    longest: float = 2.0  # seconds of processor time that one input may take


class BrokenPromiseError(AssertionError):
    """A reader did not keep its word: the text says how."""


def answer(reader: Reader, data: bytes) -> str:
    """ "read" or "refused"; raises `BrokenPromiseError`, and whatever else the reader raises."""
    try:
        reader.read(data)
    except InputError as error:
        message = str(error)
        if "\n" in message or not 0 < len(message) <= LONGEST_MESSAGE:
            raise BrokenPromiseError(f"the refusal is not one short line: {message[:300]!r}") from error
        return "refused"
    return "read"


def damaged(reader: Reader, rng: np.random.Generator) -> bytes:
    """One of the seeds after one to four random accidents."""
    data = _pick(reader.seeds, rng)
    if reader.container is None or rng.random() < 0.5:
        return _hurt(data, reader, rng)
    parts = reader.container.unpack(data)
    which = int(rng.integers(len(parts)))
    parts[which] = _hurt(parts[which], reader, rng)
    return reader.container.pack(parts)


def _hurt(data: bytes, reader: Reader, rng: np.random.Generator) -> bytes:
    for _ in range(int(min(rng.geometric(0.6), 4))):
        accident = _ACCIDENTS[int(rng.integers(len(_ACCIDENTS)))]
        data = accident(data, reader, rng) if data else data
    return data


def _flip(data: bytes, _: Reader, rng: np.random.Generator) -> bytes:
    """A few bytes take other values."""
    changed = bytearray(data)
    for at in rng.integers(len(data), size=int(rng.integers(1, 9))):
        changed[int(at)] = int(rng.integers(256))
    return bytes(changed)


def _retype(data: bytes, _: Reader, rng: np.random.Generator) -> bytes:
    """Some characters of a text become others that any text may have."""
    changed = bytearray(data)
    for at in rng.integers(len(data), size=int(rng.integers(1, 5))):
        if changed[int(at)] in _HARMLESS:
            changed[int(at)] = _HARMLESS[int(rng.integers(len(_HARMLESS)))]
    return bytes(changed)


def _rename(data: bytes, reader: Reader, rng: np.random.Generator) -> bytes:
    """A name gives way to another one: a field of another kind, a node that is not there."""
    donor = reader.seeds[int(rng.integers(len(reader.seeds)))]
    names, others = (list(_NAME.finditer(text[:200_000])) for text in (data, donor))
    if not names or not others:
        return data
    at, other = names[int(rng.integers(len(names)))], others[int(rng.integers(len(others)))]
    return data[: at.start()] + other.group() + data[at.end() :]


def _truncate(data: bytes, _: Reader, rng: np.random.Generator) -> bytes:
    return data[: int(rng.integers(len(data)))]


def _drop(data: bytes, _: Reader, rng: np.random.Generator) -> bytes:
    """A slice is missing."""
    start, end = _slice(data, rng)
    return data[:start] + data[end:]


def _repeat(data: bytes, _: Reader, rng: np.random.Generator) -> bytes:
    """A short slice comes again and again: openings without ends, or very long lists."""
    start = int(rng.integers(len(data)))
    piece = data[start : start + int(rng.integers(1, 60))]
    return data[:start] + piece * int(rng.integers(2, _BOMB)) + data[start:]


def _move(data: bytes, reader: Reader, rng: np.random.Generator) -> bytes:
    """A slice of a seed lands somewhere else."""
    donor = reader.seeds[int(rng.integers(len(reader.seeds)))]
    start, end = _slice(donor, rng)
    at = int(rng.integers(len(data)))
    return data[:at] + donor[start:end] + data[at:]


def _number(data: bytes, _: Reader, rng: np.random.Generator) -> bytes:
    """Some number becomes huge, tiny, negative or none."""
    found = list(_NUMBER.finditer(data[:200_000]))
    if not found:
        return data
    at = found[int(rng.integers(len(found)))]
    return data[: at.start()] + _pick(_HUGE, rng) + data[at.end() :]


def _word(data: bytes, reader: Reader, rng: np.random.Generator) -> bytes:
    """A piece of the grammar stands where it should not, perhaps many times."""
    if not reader.words:
        return data
    at = int(rng.integers(len(data)))
    times = int(rng.integers(1, _BOMB)) if rng.random() < 0.2 else 1
    return data[:at] + (b" " + _pick(reader.words, rng) + b" ") * times + data[at:]


def _slice(data: bytes, rng: np.random.Generator) -> tuple[int, int]:
    start = int(rng.integers(len(data)))
    return start, start + int(rng.integers(1, 1 + max(1, (len(data) - start) // 2)))


def _pick(pieces: Sequence[bytes], rng: np.random.Generator) -> bytes:
    return pieces[int(rng.integers(len(pieces)))]


_ACCIDENTS = (_flip, _retype, _rename, _truncate, _drop, _repeat, _move, _number, _word)
