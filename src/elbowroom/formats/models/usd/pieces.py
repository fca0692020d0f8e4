"""What a USD stage shows, as triangles: meshes, simple solids, and what instances show many times over."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.polygons import ears

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MOST_TRIANGLES = 2_000_000
_DEEPEST = 64  # instances within instances
_SOLIDS = ("Cube", "Sphere", "Cylinder", "Cone", "Capsule", "Plane")
# Where x, y, z of a solid that stands along Z go, by its axis; of a plane too, whose width and length are along these.
_ALONG = {"X": [[0, 1, 0], [0, 0, 1], [1, 0, 0]], "Y": [[0, 0, 1], [1, 0, 0], [0, 1, 0]], "Z": np.eye(3)}
_ACROSS = {"X": [[0, 0, 1], [0, 1, 0], [1, 0, 0]], "Y": [[1, 0, 0], [0, 0, 1], [0, 1, 0]], "Z": np.eye(3)}


class PrimPiece(NamedTuple):
    """Triangles of one prim."""

    path: tuple[str, ...]  # names, from the top
    points: Floats  # (V, 3) in the stage's axes and units
    faces: Ints  # (F, 3)
    colour: tuple[float, float, float] | None  # linear; None where it tells none


def pieces_of(stage: Any, name: str) -> Iterator[PrimPiece]:
    """All that is shown, at the first moment; raises `InputError`."""
    left = _MOST_TRIANGLES
    for piece in _under(stage.GetPseudoRoot(), np.eye(4), (), name, 0):
        left -= len(piece.faces)
        if left < 0:
            raise InputError(f"{name}: more than {_MOST_TRIANGLES} triangles")
        yield piece


def _under(top: Any, moved: Floats, above: tuple[str, ...], name: str, depth: int) -> Iterator[PrimPiece]:
    """What a prim and those below it show; `moved` (4, 4, points in rows) is what their world is moved by."""
    from pxr import Usd, UsdGeom

    if depth > _DEEPEST:
        raise InputError(f"{name}: instances hang more than {_DEEPEST} deep")
    worlds = UsdGeom.XformCache(Usd.TimeCode.EarliestTime())
    within = iter(Usd.PrimRange(top, Usd.TraverseInstanceProxies()))
    for prim in within:
        if _is_unseen(prim):
            within.PruneChildren()
            continue
        world = _numbers(worlds.GetLocalToWorldTransform(prim)) @ moved
        path = (*above, *prim.GetPath().pathString.strip("/").split("/"))
        if prim.IsA(UsdGeom.PointInstancer):
            within.PruneChildren()
            yield from _instances(prim, world, path, name, depth)
        elif prim.IsA(UsdGeom.Mesh) or prim.GetTypeName() in _SOLIDS:
            points, faces = _mesh(prim, name) if prim.IsA(UsdGeom.Mesh) else _solid(prim)
            if len(faces):
                yield PrimPiece(path, points @ world[:3, :3] + world[3, :3], faces, _colour(prim))


def _is_unseen(prim: Any) -> bool:
    from pxr import UsdGeom

    imageable = UsdGeom.Imageable(prim)
    if not imageable:
        return False
    shown = (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
    hidden = imageable.GetVisibilityAttr().Get(_first()) == UsdGeom.Tokens.invisible
    return hidden or imageable.ComputePurpose() not in shown


def _instances(prim: Any, world: Floats, path: tuple[str, ...], name: str, depth: int) -> Iterator[PrimPiece]:
    """What a PointInstancer shows: each of its prototypes, wherever one stands."""
    from pxr import UsdGeom

    instancer = UsdGeom.PointInstancer(prim)
    stage, prototypes = prim.GetStage(), instancer.GetPrototypesRel().GetForwardedTargets()
    which = instancer.GetProtoIndicesAttr().Get(_first()) or ()
    placed = instancer.ComputeInstanceTransformsAtTime(_first(), _first(), UsdGeom.PointInstancer.ExcludeProtoXform)
    known: dict[int, list[PrimPiece]] = {}
    for number, matrix in zip(which, placed, strict=False):
        if not 0 <= number < len(prototypes):
            raise InputError(f"{name}: {prim.GetPath()}: there is no prototype {number}")
        if number not in known:
            top = stage.GetPrimAtPath(prototypes[number])
            if not top:
                raise InputError(f"{name}: {prim.GetPath()}: there is no {prototypes[number]}")
            parent = UsdGeom.XformCache(_first()).GetParentToWorldTransform(top)
            known[number] = list(_under(top, _numbers(parent.GetInverse()), path, name, depth + 1))
        to_world = _numbers(matrix) @ world
        for piece in known[number]:
            yield piece._replace(points=piece.points @ to_world[:3, :3] + to_world[3, :3])


def _mesh(prim: Any, name: str) -> tuple[Floats, Ints]:
    from pxr import UsdGeom

    mesh = UsdGeom.Mesh(prim)
    points = np.asarray(mesh.GetPointsAttr().Get(_first()) or (), np.float64).reshape(-1, 3)
    counts = np.asarray(mesh.GetFaceVertexCountsAttr().Get(_first()) or (), np.int64)
    corners = np.asarray(mesh.GetFaceVertexIndicesAttr().Get(_first()) or (), np.int64)
    holes = np.asarray(mesh.GetHoleIndicesAttr().Get(_first()) or (), np.int64)
    where = f"{name}: {prim.GetPath()}"
    if not np.isfinite(points).all():
        raise InputError(f"{where}: its points are not finite")
    if (counts < 0).any() or counts.sum() != len(corners):
        raise InputError(f"{where}: its faces have {counts.sum()} corners; {len(corners)} are told")
    if len(corners) and not (corners.min() >= 0 and corners.max() < len(points)):
        raise InputError(f"{where}: a face names a point that is not there")
    counts[holes[(holes >= 0) & (holes < len(counts))]] *= -1  # a face that is a hole
    return points, _triangles(points, counts, corners)


def _triangles(points: Floats, counts: Ints, corners: Ints) -> Ints:
    """Triangles (F, 3) of faces with so many corners, one after the other; none of those whose count is negative."""
    firsts, many = np.cumsum(np.abs(counts)) - np.abs(counts), counts >= 3
    places, _ = ears(points, corners, firsts[many], counts[many])
    return corners[places]


def _solid(prim: Any) -> tuple[Floats, Ints]:
    """A simple solid in its own axes."""
    from trimesh import creation

    def told(attribute: str, otherwise: float) -> float:
        value = prim.GetAttribute(attribute).Get(_first())
        return abs(float(value)) if isinstance(value, int | float) else otherwise

    kind, radius, height = str(prim.GetTypeName()), told("radius", 1.0), told("height", 2.0)
    if kind == "Cube":
        made = creation.box(extents=[told("size", 2.0)] * 3)
    elif kind == "Plane":
        made = creation.box(extents=[told("width", 2.0), told("length", 2.0), 0.0])
    elif kind == "Sphere":
        made = creation.icosphere(3, radius)
    elif kind == "Capsule":
        made = creation.capsule(told("height", 1.0), told("radius", 0.5))
        made.apply_translation([0.0, 0.0, -made.bounds.mean(axis=0)[2]])
    elif kind == "Cone":
        made = creation.cone(radius, height)
        made.apply_translation([0.0, 0.0, -0.5 * height])
    else:
        made = creation.cylinder(radius, height)
    turns = _ACROSS if kind == "Plane" else _ALONG
    turn = np.asarray(turns.get(str(prim.GetAttribute("axis").Get(_first())), np.eye(3)))
    return np.asarray(made.vertices, np.float64) @ turn, np.asarray(made.faces, np.int64)


def _colour(prim: Any) -> tuple[float, float, float] | None:
    """That of its material, or else of its own primvar."""
    from pxr import UsdGeom, UsdShade

    material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
    value = None
    if material:
        surface = material.ComputeSurfaceSource()[0]
        diffuse = surface.GetInput("diffuseColor") if surface else None
        value = diffuse.Get() if diffuse and not diffuse.HasConnectedSource() else None
    if value is None:
        several = UsdGeom.Gprim(prim).GetDisplayColorAttr().Get(_first())
        value = several[0] if several else None
    if value is None or not np.isfinite(np.asarray(value, np.float64)).all():
        return None
    red, green, blue = np.clip(np.asarray(value, np.float64), 0.0, 1.0).tolist()
    return red, green, blue


def _numbers(matrix: Any) -> Floats:
    return np.array(matrix, np.float64)


def _first() -> Any:
    from pxr import Usd

    return Usd.TimeCode.EarliestTime()
