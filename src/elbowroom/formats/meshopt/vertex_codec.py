"""The vertex codec of meshoptimizer, versions 0 and 1 (mode ATTRIBUTES).

Source: EXT_meshopt_compression and KHR_meshopt_compression, appendix "Bitstream", mode 0 (Khronos glTF extensions).
Elements come in blocks; in a block every byte (or channel of four bytes) of all elements is stored as a plane of deltas
to the element before, in groups of 16 that take 0, 1, 2, 4 or 8 bits a value.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper

Bytes = NDArray[np.uint8]

HEADER = 0xA0
_GROUP = 16
_BLOCK_BYTES, _BLOCK_MOST = 8192, 256
_TAIL_0, _TAIL_1 = 32, 24
_BAD = -1


@helper
def _group(data: Bytes, at: int, end: int, bits: int, out: Bytes, start: int) -> int:
    """16 values of `bits` bits each into out[start:]; the position behind them, or -1 at the end of the data."""
    if bits == 0:
        out[start : start + _GROUP] = 0
        return at
    if bits == 8:
        if at + _GROUP > end:
            return _BAD
        out[start : start + _GROUP] = data[at : at + _GROUP]
        return at + _GROUP
    packed = _GROUP * bits // 8
    spare = at + packed
    if spare > end:
        return _BAD
    escape = (1 << bits) - 1
    for i in range(_GROUP):
        place = i * bits
        byte = int(data[at + (place >> 3)])
        shift = (place & 7) if bits == 1 else 8 - bits - (place & 7)
        value = (byte >> shift) & escape
        if value == escape:
            if spare >= end:
                return _BAD
            value = int(data[spare])
            spare += 1
        out[start + i] = value
    return spare


@helper
def _plane(data: Bytes, at: int, end: int, first_bits: int, version: int, count: int, out: Bytes, start: int) -> int:
    """A plane of `count` values (a multiple of 16), each group with its own width out of four."""
    groups = count // _GROUP
    header = at
    at += (groups + 3) // 4
    if at > end:
        return _BAD
    for group in range(groups):
        code = (int(data[header + group // 4]) >> (2 * (group % 4))) & 3
        if version == 0:
            bits = 1 << code if code > 0 else 0
        else:
            bits = (1 << (code - 1 + first_bits)) if code + first_bits > 0 else 0
        at = _group(data, at, end, bits, out, start + group * _GROUP)
        if at < 0:
            return _BAD
    return at


@helper
def _undo_deltas(planes: Bytes, stride: int, channel: int, last: Bytes, out: Bytes, first: int, k: int, n: int) -> None:
    """Four planes (of `stride` bytes each) of deltas into bytes k to k+3 of the elements first to first+n-1."""
    kind = channel & 3
    width = 1 if kind == 0 else (2 if kind == 1 else 4)
    turn = (32 - (channel >> 4)) & 31
    mask = (1 << (8 * width)) - 1
    for part in range(0, 4, width):
        value = 0
        for j in range(width):
            value |= int(last[k + part + j]) << (8 * j)
        for i in range(n):
            delta = 0
            for j in range(width):
                delta |= int(planes[(part + j) * stride + i]) << (8 * j)
            if kind == 2:
                turned = ((delta << turn) | (delta >> ((32 - turn) & 31))) & mask
                value = turned ^ value
            else:
                value = (((delta >> 1) ^ (-(delta & 1))) + value) & mask
            for j in range(width):
                out[first + i, k + part + j] = (value >> (8 * j)) & 255
        for j in range(width):
            last[k + part + j] = (value >> (8 * j)) & 255


@exact_kernel
def decode_vertices(data: Bytes, count: int, size: int) -> tuple[Bytes, bool]:
    """`count` elements of `size` bytes (a multiple of 4, at most 256), and whether the data is whole."""
    out = np.zeros((count, size), np.uint8)
    if len(data) < 1 or (data[0] & 0xF0) != HEADER or (data[0] & 0x0F) > 1:
        return out, False
    version = int(data[0] & 0x0F)
    tail = size + (size // 4 if version else 0)
    padded = max(tail, _TAIL_1 if version else _TAIL_0)
    end = len(data) - padded
    if end < 1:
        return out, False
    last = data[len(data) - tail : len(data) - tail + size].copy()
    channels = np.zeros(size // 4, np.uint8)
    if version:
        channels[:] = data[len(data) - size // 4 :]
    at = 1
    block = min((_BLOCK_BYTES // size) & ~(_GROUP - 1), _BLOCK_MOST)
    planes = np.zeros(4 * block, np.uint8)
    for first in range(0, count, block):
        n = min(block, count - first)
        padded_n = (n + _GROUP - 1) & ~(_GROUP - 1)
        control = at
        at += size // 4 if version else 0
        if at > end:
            return out, False
        for k in range(0, size, 4):
            for j in range(4):
                mode = (int(data[control + k // 4]) >> (2 * j)) & 3 if version else 0
                if mode == 2 and version:
                    planes[j * block : j * block + n] = 0
                elif mode == 3 and version:
                    if at + n > end:
                        return out, False
                    planes[j * block : j * block + n] = data[at : at + n]
                    at += n
                else:
                    at = _plane(data, at, end, mode, version, padded_n, planes, j * block)
                    if at < 0:
                        return out, False
            _undo_deltas(planes, block, int(channels[k // 4]), last, out, first, k, n)
    return out, at == end
