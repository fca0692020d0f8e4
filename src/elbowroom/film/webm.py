"""WebM files: pictures that are compressed already, one after the other in a Matroska container (RFC 9559)."""

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import BinaryIO

_TICKS = 1000  # a second, as Matroska counts by default
_LONGEST_CLUSTER = 30_000  # ticks: a block's time within its cluster is a 16-bit number
_UNKNOWN_SIZE = b"\x01" + b"\xff" * 7


@dataclass(frozen=True)
class Packet:
    """One compressed picture."""

    data: bytes
    time: float  # seconds
    key: bool  # it can be shown without those before it


def write_webm(file: BinaryIO, packets: Iterable[Packet], size: tuple[int, int], codec: str) -> None:
    """Write the pictures, `size` pixels each; `codec` as Matroska names it, such as "V_VP8"."""
    file.write(_element(0x1A45DFA3, _ebml_head()))
    file.write(_id(0x18538067) + _UNKNOWN_SIZE)  # the segment, to the end of the file
    file.write(
        _element(
            0x1549A966, _number(0x2AD7B1, 10**9 // _TICKS) + _text(0x4D80, "elbowroom") + _text(0x5741, "elbowroom")
        )
    )
    file.write(_element(0x1654AE6B, _element(0xAE, _track(size, codec))))
    begun, blocks = 0, b""
    for packet in packets:
        ticks = round(packet.time * _TICKS)
        if blocks and (ticks - begun > _LONGEST_CLUSTER or (packet.key and ticks - begun >= _TICKS)):
            file.write(_cluster(begun, blocks))
            blocks = b""
        if not blocks:
            begun = ticks
        head = b"\x81" + struct.pack(">hB", ticks - begun, 0x80 if packet.key else 0)
        blocks += _element(0xA3, head + packet.data)
    if blocks:
        file.write(_cluster(begun, blocks))


def _ebml_head() -> bytes:
    numbers = {0x4286: 1, 0x42F7: 1, 0x42F2: 4, 0x42F3: 8, 0x4287: 4, 0x4285: 2}  # versions and longest lengths
    return b"".join(_number(name, value) for name, value in numbers.items()) + _text(0x4282, "webm")


def _track(size: tuple[int, int], codec: str) -> bytes:
    number, video = (
        _number(0xD7, 1) + _number(0x73C5, 1) + _number(0x83, 1),
        _number(0xB0, size[0]) + _number(0xBA, size[1]),
    )
    return number + _text(0x86, codec) + _element(0xE0, video)


def _cluster(begun: int, blocks: bytes) -> bytes:
    return _element(0x1F43B675, _number(0xE7, begun) + blocks)


def _element(name: int, content: bytes) -> bytes:
    return _id(name) + (len(content) | 1 << 56).to_bytes(8, "big") + content


def _id(name: int) -> bytes:
    return name.to_bytes((name.bit_length() + 7) // 8, "big")


def _number(name: int, value: int) -> bytes:
    return _element(name, value.to_bytes(max(1, (value.bit_length() + 7) // 8), "big"))


def _text(name: int, value: str) -> bytes:
    return _element(name, value.encode())
