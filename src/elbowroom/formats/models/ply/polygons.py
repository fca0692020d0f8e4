"""PLY files with all faces in triangles.

Of others trimesh makes fans, which lead out of dents, and reads no binary file whose faces have different numbers of
corners, as Blender writes them.
"""

import re

import numpy as np

from elbowroom.formats.models.ply.binary import binary_faces
from elbowroom.formats.models.ply.header import header_of
from elbowroom.formats.models.ply.text import text_faces
from elbowroom.formats.polygons import ears

_COUNT = re.compile(rb"(\nelement[ \t]+face[ \t]+)\d+")


def in_triangles(data: bytes) -> bytes:
    """The same file with all faces in triangles; one that has no others, or is not understood, as it is."""
    try:
        return _in_triangles(data)
    except (ValueError, IndexError, KeyError, OverflowError):
        return data


def _in_triangles(data: bytes) -> bytes:
    header = header_of(data)
    faces = binary_faces(data, header) if header.order else text_faces(data, header)
    if np.all(faces.sizes == 3) or faces.corners.min() < 0 or faces.corners.max() >= len(faces.points):
        return data
    whole, starts = np.flatnonzero(faces.sizes >= 3), np.cumsum(faces.sizes) - faces.sizes
    cut, owners = ears(faces.points, faces.corners, starts[whole], faces.sizes[whole])
    in_order = np.argsort(owners, kind="stable")
    written = faces.written(faces.corners[cut[in_order]], whole[owners[in_order]])
    told = _COUNT.sub(rb"\g<1>%d" % len(cut), header.text, count=1)
    begin, end = faces.span
    return told + data[len(header.text) : begin] + written + data[end:]
