"""Eyeballs, lids and lashes: sheets on spheres about the eye joints, so that every edge is clean."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from make_stock_avatar.fields import Array
from make_stock_avatar.polygonise import Mesh
from make_stock_avatar.rest import EYE_CENTRE

EYE_RADIUS = 0.0235  # metres
_CORNER = 50.0  # azimuth of the corners of the eye, degrees
_CLOSED = -13.0  # elevation at which the lids meet, degrees

Edge = Callable[[Array], Array]  # azimuths (N,) -> elevations of a lid's edge (N,), degrees


@dataclass(frozen=True, eq=False)
class Sheet:
    """A patch of the face with its shapes."""

    mesh: Mesh
    colours: Array  # (V, 3) linear RGB
    targets: dict[str, Array]  # name of the shape -> offsets of the points (V, 3), metres


def direction(azimuth: Array, elevation: Array) -> Array:
    """Unit vectors (N, 3) from degrees; azimuth towards the outer corner (+X for the left eye)."""
    a, e = np.radians(azimuth), np.radians(elevation)
    return np.column_stack([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])


def upper_edge(azimuth: Array) -> Array:
    """Elevation of the open upper lid, degrees: a high arch, the outer corner a little raised."""
    u = np.clip(azimuth / _CORNER, -1.0, 1.0)
    return np.asarray(-4.0 + 3.0 * u + 30.0 * (1.0 - np.abs(u + 0.06 * (1 - u * u)) ** 2.3))


def lower_edge(azimuth: Array) -> Array:
    """Elevation of the lower lid, degrees."""
    u = np.clip(azimuth / _CORNER, -1.0, 1.0)
    return np.asarray(-4.0 + 3.0 * u - 22.0 * (1.0 - np.abs(u - 0.05 * (1 - u * u)) ** 2.6))


def closed_edge(azimuth: Array) -> Array:
    """Elevation of the seam of the closed eye, degrees."""
    u = np.clip(azimuth / _CORNER, -1.0, 1.0)
    return np.asarray(-4.0 + 3.0 * u + (_CLOSED + 4.0) * (1.0 - u * u))


def _grid_triangles(rows: int, columns: int) -> NDArray[np.int64]:
    """Two triangles for every cell of a (rows, columns) grid of points, (T, 3)."""
    i = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    return np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def sheet_mesh(points: Array, rows: int, columns: int, outward: Array) -> Mesh:
    """A grid of points as a mesh whose normals (area weighted) agree with `outward` (3,)."""
    triangles = _grid_triangles(rows, columns)
    normal = _vertex_normals(points, triangles)
    if (normal @ outward).mean() < 0:
        triangles, normal = triangles[:, ::-1], -normal
    return Mesh(points, normal, triangles)


def _vertex_normals(points: Array, triangles: NDArray[np.int64]) -> Array:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    face = np.cross(b - a, c - a)
    total = np.zeros_like(points)
    for i in range(3):
        np.add.at(total, triangles[:, i], face)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    flat = length < 1e-12  # where a ribbon ends in a point
    return np.where(flat, np.array([0.0, 0.0, 1.0]), total / np.where(flat, 1.0, length))


_LID_AZIMUTHS = np.concatenate([[-84, -70, -59], np.linspace(-_CORNER, _CORNER, 19), [59, 70, 84]])
_LID_STEPS = np.array([0.0, 0.0, 0.035, 0.16, 0.38, 0.68, 1.0])  # from edge to back
_UPPER_HEIGHTS = np.array([0.985, 1.030, 1.050, 1.055, 1.050, 1.03, 1.0])  # of the eye radius
_LOWER_HEIGHTS = np.array([0.985, 1.022, 1.030, 1.026, 1.005, 0.98, 0.96])


def _lid(edge: Edge, back: float, heights: Array) -> Array:
    azimuth = np.tile(_LID_AZIMUTHS, len(_LID_STEPS))
    step = np.repeat(_LID_STEPS, len(_LID_AZIMUTHS))
    start = edge(azimuth)
    height = np.repeat(heights, len(_LID_AZIMUTHS))[:, None] * EYE_RADIUS
    return np.array(EYE_CENTRE) + height * direction(azimuth, start + (back - start) * step)


def _lash(edge: Edge) -> Array:
    u = np.linspace(-1.0, 1.0, 19)
    azimuth = u * (_CORNER + 1.0) + 2.0 * (u > 0.9)
    low = edge(azimuth) - 1.0
    thick = 1.5 + 5.5 * np.clip(1.0 - np.abs(u - 0.25) ** 3.0, 0.0, 1.0) * (0.55 + 0.45 * (u + 1) / 2)
    rows = [direction(azimuth, low + thick * s) * EYE_RADIUS * h for s, h in ((0, 1.035), (0.5, 1.075), (1, 1.06))]
    return np.array(EYE_CENTRE) + np.concatenate(rows)


def _between(start: Edge, end: Edge, share: float) -> Edge:
    return lambda azimuth: np.asarray(start(azimuth) * (1.0 - share) + end(azimuth) * share)


# how far each shape moves the upper and the lower lid towards the closed seam
_SHAPES: dict[str, tuple[float, float]] = {
    "blink": (1.0, 1.0),
    "droop": (0.38, 0.0),
    "squint": (0.15, 0.75),
    "wide": (-0.14, -0.08),
}


def _lid_sheet(shape: Callable[[Edge], Array], edge: Edge, rows: int, colour: Array, which: int) -> Sheet:
    points = shape(edge)
    mesh = sheet_mesh(points, rows, len(points) // rows, np.array([0.0, 0.0, 1.0]))
    targets = {name: shape(_between(edge, closed_edge, shares[which])) - points for name, shares in _SHAPES.items()}
    return Sheet(mesh, np.tile(colour, (len(points), 1)), targets)


def lids(skin: Array) -> list[Sheet]:
    """Upper and lower lid of the left eye, with the shapes of `_SHAPES`."""
    rows = len(_LID_STEPS)
    return [
        _lid_sheet(lambda edge: _lid(edge, 96.0, _UPPER_HEIGHTS), upper_edge, rows, skin, 0),
        _lid_sheet(lambda edge: _lid(edge, -92.0, _LOWER_HEIGHTS), lower_edge, rows, skin, 1),
    ]


def lash(colour: Array) -> Sheet:
    """The line of lashes along the left upper lid, which follows the lid."""
    return _lid_sheet(_lash, upper_edge, 3, colour, 0)


# angles from the line of sight (degrees) and colours (linear RGB) of the rings of the eye
_BANDS: tuple[tuple[tuple[float, ...], tuple[tuple[float, float, float], ...]], ...] = (
    ((0.0, 6.0, 11.5), ((0.008, 0.006, 0.006),) * 3),
    ((11.5, 17.0, 23.0), ((0.16, 0.075, 0.025), (0.13, 0.055, 0.018), (0.07, 0.028, 0.010))),
    ((23.0, 26.0), ((0.022, 0.010, 0.006),) * 2),
    ((26.0, 36.0, 52.0, 78.0), ((0.82, 0.81, 0.79),) * 2 + ((0.74, 0.70, 0.68), (0.5, 0.42, 0.40))),
)


def eyeball(glint: float) -> Sheet:
    """The left eyeball, with pupil, iris and two glints, the larger on the +X side if `glint` is 1 (-1: other side)."""
    pieces = [_cap(angles, colours, 24, 1.0) for angles, colours in _BANDS]
    white = ((1.0, 1.0, 1.0),) * 2
    pieces.append(_moved(_cap((0.0, 4.6), white, 16, 1.012), 8.5 * glint, 10.5))
    pieces.append(_moved(_cap((0.0, 2.0), white, 12, 1.012), -9.0 * glint, -9.0))
    return joined([Sheet(_placed(mesh), colour, {}) for mesh, colour in pieces])


def _cap(
    angles: tuple[float, ...], colours: tuple[tuple[float, float, float], ...], slices: int, height: float
) -> tuple[Mesh, Array]:
    turn = np.linspace(0.0, 2.0 * np.pi, slices + 1)
    rings = []
    for angle in np.radians(angles):
        r = np.sin(angle)
        rings.append(np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(len(turn), np.cos(angle))]))
    unit = np.concatenate(rings)
    triangles = _grid_triangles(len(angles), slices + 1)
    corner = unit[triangles]
    facing = (np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]) * corner[:, 0]).sum(axis=1)
    triangles = np.where((facing < 0)[:, None], triangles[:, ::-1], triangles)[np.abs(facing) > 1e-9]
    used = np.unique(triangles)
    mesh = Mesh(unit[used] * height, unit[used], np.searchsorted(used, triangles))
    return mesh, np.repeat(np.array(colours), slices + 1, axis=0)[used]


def _moved(piece: tuple[Mesh, Array], azimuth: float, elevation: float) -> tuple[Mesh, Array]:
    mesh, colours = piece
    z = direction(np.array([azimuth]), np.array([elevation]))[0]
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    frame = np.column_stack([x, np.cross(z, x), z])
    return Mesh(mesh.points @ frame.T, mesh.normals @ frame.T, mesh.triangles), colours


def _placed(mesh: Mesh) -> Mesh:
    return Mesh(np.array(EYE_CENTRE) + EYE_RADIUS * mesh.points, mesh.normals, mesh.triangles)


def joined(sheets: list[Sheet]) -> Sheet:
    """Several sheets as one; a target that a sheet lacks leaves it at rest."""
    names = sorted({name for sheet in sheets for name in sheet.targets})
    offsets = np.cumsum([0] + [len(sheet.mesh.points) for sheet in sheets])
    mesh = Mesh(
        np.concatenate([s.mesh.points for s in sheets]),
        np.concatenate([s.mesh.normals for s in sheets]),
        np.concatenate([s.mesh.triangles + o for s, o in zip(sheets, offsets, strict=False)]),
    )
    targets = {
        name: np.concatenate([s.targets.get(name, np.zeros_like(s.mesh.points)) for s in sheets]) for name in names
    }
    return Sheet(mesh, np.concatenate([s.colours for s in sheets]), targets)


def mirrored_sheet(sheet: Sheet) -> Sheet:
    """The same on the right side."""
    flip = np.array([-1.0, 1.0, 1.0])
    return Sheet(sheet.mesh.mirrored(), sheet.colours, {name: d * flip for name, d in sheet.targets.items()})
