"""The faces of a binary file, whose lists may be of different lengths."""

from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from elbowroom.formats.models.ply.faces import Faces, Floats, Ints
from elbowroom.formats.models.ply.header import CORNERS, SIZE, Element, Header

Bytes = NDArray[np.uint8]


class _Row(NamedTuple):
    """How a face lies in the file, in bytes."""

    ahead: int  # before the length of its list
    size: int  # of that
    corner: int  # of each corner
    after: int  # behind the list


class _Lists(NamedTuple):
    """Where faces lie."""

    starts: Ints  # (F,) bytes
    sizes: Ints  # (F,) corners


def binary_faces(data: bytes, header: Header) -> Faces:
    """Read them; raises ValueError where the file ends too soon."""
    begin, points = len(header.text), np.zeros((0, 3))
    for element in header.before:
        row = element.row(header.order)
        if element.name == "vertex":
            points = _places(np.frombuffer(data, row, element.count, begin), element)
        begin += element.count * row.itemsize
    row = header.faces.row(header.order, corners=1)
    (size, ahead), (corner, at) = (row.fields[name][:2] for name in (SIZE, CORNERS))  # type: ignore[index]
    lies = _Row(ahead, size.itemsize, corner.itemsize, row.itemsize - at - corner.itemsize)
    lists, end = _lists(data, begin, header, lies)
    whole = np.frombuffer(data, np.uint8)
    first = np.cumsum(lists.sizes) - lists.sizes
    within = np.arange(int(lists.sizes.sum())) - np.repeat(first, lists.sizes)
    own = np.repeat(lists.starts + ahead + lies.size, lists.sizes) + lies.corner * within
    corners = _pieces(whole, own, lies.corner).view(corner.base)[:, 0].astype(np.int64)
    return Faces(points, corners, lists.sizes, (begin, end), partial(_written, whole, header, lies, lists))


def _places(rows: NDArray[np.void], vertex: Element) -> Floats:
    return np.stack([rows[str(vertex.at(axis))].astype(np.float64) for axis in "xyz"], axis=1)


def _lists(data: bytes, begin: int, header: Header, lies: _Row) -> tuple[_Lists, int]:
    """Where each face lies, and where the last one ends."""
    signed = header.faces.lists[0].counted.startswith("i")
    starts, sizes, at, beside = list[int](), list[int](), begin, lies.ahead + lies.size + lies.after
    for _ in range(header.faces.count):
        told = data[at + lies.ahead : at + lies.ahead + lies.size]
        size = int.from_bytes(told, "big" if header.order == ">" else "little", signed=signed)
        if size < 0 or at + beside > len(data):
            raise ValueError("cut off")
        starts.append(at)
        sizes.append(size)
        at += beside + size * lies.corner
    if at > len(data):
        raise ValueError("cut off")
    return _Lists(np.array(starts, np.int64), np.array(sizes, np.int64)), at


def _pieces(whole: Bytes, starts: Ints, length: int) -> Bytes:
    """Pieces (N, length) of a file that begin at some bytes (N,)."""
    pieces: Bytes = (
        sliding_window_view(whole, length)[starts].copy() if length and len(starts) else np.zeros((0, 1), np.uint8)
    )
    return pieces


def _written(whole: Bytes, header: Header, lies: _Row, lists: _Lists, triangles: Ints, owners: Ints) -> bytes:
    rows = np.zeros(len(triangles), header.faces.row(header.order, corners=3))
    rows[SIZE], rows[CORNERS] = 3, triangles
    written, starts = rows.view(np.uint8).reshape(len(rows), -1), lists.starts[owners]
    if lies.ahead:
        written[:, : lies.ahead] = _pieces(whole, starts, lies.ahead)
    if lies.after:
        behind = starts + lies.ahead + lies.size + lies.corner * lists.sizes[owners]
        written[:, -lies.after :] = _pieces(whole, behind, lies.after)
    return rows.tobytes()
