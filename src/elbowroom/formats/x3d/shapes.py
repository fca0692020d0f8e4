"""The triangles of a geometry node, whichever it is."""

from collections.abc import Callable

from elbowroom.formats.x3d.faces import FACE_SETS, indexed_face_set, triangle_set
from elbowroom.formats.x3d.mesh import Mesh
from elbowroom.formats.x3d.model import Node
from elbowroom.formats.x3d.solids import box, cone, cylinder, sphere
from elbowroom.formats.x3d.sweeps import elevation_grid, extrusion

_READERS: dict[str, Callable[[Node], Mesh | None]] = {
    "Box": box,
    "Cone": cone,
    "Cylinder": cylinder,
    "Sphere": sphere,
    "ElevationGrid": elevation_grid,
    "Extrusion": extrusion,
    "IndexedFaceSet": indexed_face_set,
    **dict.fromkeys(FACE_SETS, triangle_set),
}


def triangles_of(geometry: Node) -> Mesh | None:
    """The mesh of a geometry node; None for lines, points, texts and unknown nodes, which have no faces."""
    reader = _READERS.get(geometry.kind)
    return reader(geometry) if reader else None
