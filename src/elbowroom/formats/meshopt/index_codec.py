"""The index codecs of meshoptimizer: triangles (mode TRIANGLES) and plain sequences (mode INDICES).

Source: EXT_meshopt_compression, appendix "Bitstream", modes 1 and 2 (Khronos glTF extensions). Triangles refer to the
last 16 edges and vertices; what is new is counted on or stored as a delta.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain

Bytes = NDArray[np.uint8]
Indices = NDArray[np.uint32]
Queue = NDArray[np.int64]

_TRIANGLES, _SEQUENCE = 0xE0, 0xD0
_TABLE, _TAIL = 16, 4  # bytes at the end
_MASK = 0xFFFFFFFF
_NEW, _YES = plain(0), plain(True)


@exact_kernel
def _number(data: Bytes, state: NDArray[np.int64], end: int) -> int:
    """A number in groups of seven bits at state[0], which moves on; state[0] = -1 at the end of the data."""
    value = 0
    for group in range(5):
        if state[0] < 0 or state[0] >= end:
            state[0] = -1
            return 0
        byte = int(data[state[0]])
        state[0] += 1
        value |= (byte & 127) << (7 * group)
        if byte < 128:
            break
    return value & _MASK


@exact_kernel
def _free(data: Bytes, state: NDArray[np.int64], end: int) -> int:
    """An index as a delta to the last free one, state[1]."""
    value = _number(data, state, end)
    state[1] = (state[1] + ((value >> 1) ^ -(value & 1))) & _MASK
    return int(state[1])


@inner_exact_kernel
def _keep_vertex(fifo: NDArray[np.int64], state: NDArray[np.int64], index: int, wanted: bool) -> None:
    fifo[state[2]] = index
    if wanted:
        state[2] = (state[2] + 1) & 15


@inner_exact_kernel
def _keep_edge(fifo: NDArray[np.int64], state: NDArray[np.int64], a: int, b: int) -> None:
    fifo[state[3], 0], fifo[state[3], 1] = a, b
    state[3] = (state[3] + 1) & 15


@exact_kernel
def _fresh(state: NDArray[np.int64]) -> int:
    """The next index that was not used yet, counted by state[4]."""
    state[4] += 1
    return int(state[4] - 1)


@helper
def _on_edge(
    data: Bytes, end: int, code: int, recent: int, edges: Queue, vertices: Queue, state: Queue, out: Indices
) -> None:
    """A triangle on one of the last 16 edges."""
    place, third = (state[3] - 1 - (code >> 4)) & 15, code & 15
    a, b, c = edges[place, 0], edges[place, 1], 0
    if third == 0:
        c = _fresh(state)
    elif third < recent:
        c = vertices[(state[2] - 1 - third) & 15]
    elif third == 15:
        c = _free(data, state, end)
    else:
        state[1] = (state[1] + third - (third ^ 3)) & _MASK
        c = state[1]
    _keep_vertex(vertices, state, c, third == 0 or third >= recent)
    _keep_edge(edges, state, c, b)
    _keep_edge(edges, state, a, c)
    out[0], out[1], out[2] = a, b, c


@inner_exact_kernel
def _corner(data: Bytes, end: int, code: int, kept: int, may_be_free: bool, state: Queue) -> int:
    """A corner by its code: 0 a new index, 15 a free one, else one that was kept."""
    if code == 0:
        return _fresh(state)
    if code == 15 and may_be_free:
        return _free(data, state, end)
    return kept


@helper
def _apart(data: Bytes, end: int, code: int, edges: Queue, vertices: Queue, state: Queue, out: Indices) -> None:
    """A triangle without a known edge; the codes of its corners are in a table or in the data."""
    in_table = code < 0xFE
    place = end + (code & 15)
    if not in_table:
        place = state[0]
        state[0] += 1
    if place >= end + (_TABLE if in_table else 0):
        state[0] = -1
        return
    pair = int(data[place])
    if pair == 0 and not in_table:
        state[4] = 0
    first, second, third = 15 if code == 0xFF else 0, pair >> 4, pair & 15
    kept_b, kept_c = vertices[(state[2] - second) & 15], vertices[(state[2] - third) & 15]
    # New indices are counted before free ones are read; both orders are the same for each of the two counters.
    a = _corner(data, end, first, _NEW, _YES, state)
    b = _corner(data, end, second, kept_b, not in_table, state)
    c = _corner(data, end, third, kept_c, not in_table, state)
    _keep_vertex(vertices, state, a, _YES)
    _keep_vertex(vertices, state, b, second == 0 or (second == 15 and not in_table))
    _keep_vertex(vertices, state, c, third == 0 or (third == 15 and not in_table))
    _keep_edge(edges, state, b, a)
    _keep_edge(edges, state, c, b)
    _keep_edge(edges, state, a, c)
    out[0], out[1], out[2] = a, b, c


@exact_kernel
def decode_triangles(data: Bytes, count: int) -> tuple[Indices, bool]:
    """`count` indices (a multiple of 3), and whether the data is whole."""
    out = np.zeros(count, np.uint32)
    if len(data) < 1 + count // 3 + _TABLE or (data[0] & 0xF0) != _TRIANGLES or (data[0] & 0x0F) > 1:
        return out, False
    recent = 13 if data[0] & 0x0F else 15
    edges, vertices = np.full((16, 2), _MASK, np.int64), np.full(16, _MASK, np.int64)
    end = len(data) - _TABLE
    state = np.zeros(5, np.int64)  # place in the data, last free index, places in the two queues, next new index
    state[0] = 1 + count // 3
    for triangle in range(count // 3):
        code, corners = int(data[1 + triangle]), out[3 * triangle : 3 * triangle + 3]
        if code < 0xF0:
            _on_edge(data, end, code, recent, edges, vertices, state, corners)
        else:
            _apart(data, end, code, edges, vertices, state, corners)
        if state[0] < 0:
            return out, False
    return out, state[0] == end


@exact_kernel
def decode_sequence(data: Bytes, count: int) -> tuple[Indices, bool]:
    """`count` indices, each a delta to one of two baselines, and whether the data is whole."""
    out = np.zeros(count, np.uint32)
    if len(data) < 1 + count + _TAIL or (data[0] & 0xF0) != _SEQUENCE or (data[0] & 0x0F) > 1:
        return out, False
    end, last, state = len(data) - _TAIL, np.zeros(2, np.int64), np.ones(1, np.int64)
    for i in range(count):
        value = _number(data, state, end)
        if state[0] < 0:
            return out, False
        base, value = value & 1, value >> 1
        last[base] = (last[base] + ((value >> 1) ^ -(value & 1))) & _MASK
        out[i] = last[base]
    return out, state[0] == end
