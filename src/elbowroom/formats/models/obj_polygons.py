"""Faces of OBJ files that have dents, as triangles: trimesh cuts every face into a fan, which leads out of those."""

import re
import warnings

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.polygons import dented, ears

_FACE = re.compile(rb"^ *f(?: +[^ \n]+){4,} *$", re.MULTILINE)  # of four corners and more
_PLACE = re.compile(rb"^ *v +([^ \n]+ +[^ \n]+ +[^ \n]+)", re.MULTILINE)
_ATTRIBUTES = re.compile(rb"/[^ \n]*")  # a corner's texture and normal

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def without_dents(data: bytes) -> bytes:
    """The same plain OBJ text with its dented faces in triangles; what is damaged is left as it is."""
    faces = list(_FACE.finditer(data))
    if not faces:
        return data
    lines = [face.group() for face in faces]
    sizes = np.array([len(line.split()) for line in lines]) - 1
    points = _numbers(b" ".join(_PLACE.findall(data))).reshape(-1, 3)
    corners = _numbers(_ATTRIBUTES.sub(b"", b"\n".join(lines)).replace(b"f", b" ")).astype(np.int64) - 1
    if len(corners) != sizes.sum() or not len(points) or corners.min() < 0 or corners.max() >= len(points):
        return data
    starts = np.cumsum(sizes) - sizes
    parts, end = [], 0
    for number in np.flatnonzero(dented(points, corners, starts, sizes)).tolist():
        begin, size = starts[number], sizes[number]
        ring = points[corners[begin : begin + size]]
        face, words = faces[number], lines[number].split()[1:]
        parts += [data[end : face.start()], _triangles(ring, words)]
        end = face.end()
    return b"".join([*parts, data[end:]])


def _numbers(text: bytes) -> Floats:
    """The numbers (N,) of a text; none if there is anything else in it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return np.fromstring(text, np.float64, sep=" ")
    except (ValueError, DeprecationWarning):
        return np.zeros(0)


def _triangles(ring: Floats, words: list[bytes]) -> bytes:
    """One face (n, 3) with such corners as lines of triangles."""
    size = np.array([len(ring)])
    cut, _ = ears(ring, np.arange(len(ring)), np.zeros(1, np.int64), size)
    return b"\n".join(b"f " + b" ".join(words[corner] for corner in triangle) for triangle in cut.tolist())
