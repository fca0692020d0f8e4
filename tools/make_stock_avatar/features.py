"""Brows and mouth: ribbons laid on the face, with the shapes of a few expressions."""

import numpy as np

from make_stock_avatar.eyes import Sheet, sheet_mesh
from make_stock_avatar.fields import Array
from make_stock_avatar.head import on_face
from make_stock_avatar.polygonise import Mesh

_FRONT = np.array([0.0, 0.0, 1.0])


def _laid(xy: Array, lift: Array) -> Array:
    """Points (N, 3) on the face at xy (N, 2), lifted by metres."""
    points = on_face(xy)
    points[:, 2] += lift
    return points


def _brow_points(raise_inner: float = 0.0, raise_outer: float = 0.0) -> Array:
    u = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 17))
    x = 0.0135 + 0.0445 * u
    y = 1.6240 + 0.0105 * np.sin(np.pi * (0.12 + 0.74 * u) ** 1.15) - 0.0035 * u
    y = y + raise_inner * (1 - u) + raise_outer * u
    half = 0.0042 * np.clip(1.0 - u**2.6, 0.0, 1.0) * np.sqrt(np.clip((u + 0.01) / 0.14, 0.0, 1.0)) + 0.0002
    sides = np.repeat([-1.0, -0.45, 0.45, 1.0], len(u))
    lift = np.where(np.abs(sides) < 1.0, 0.0014, -0.0006)
    return _laid(np.column_stack([np.tile(x, 4), np.tile(y, 4) + sides * np.tile(half, 4)]), lift)


def brow(colour: Array) -> Sheet:
    """The left brow with targets "browUp", "browSad" and "browAngry"."""
    rest = _brow_points()
    targets = {
        "browUp": _brow_points(0.007, 0.006) - rest,
        "browSad": _brow_points(0.006, -0.003) - rest,
        "browAngry": _brow_points(-0.006, 0.003) - rest,
    }
    return Sheet(sheet_mesh(rest, 4, 17, _FRONT), np.tile(colour, (len(rest), 1)), targets)


# half width, height of the corners over the middle, upper and lower opening in the middle (metres)
_MOUTHS: dict[str, tuple[float, float, float, float]] = {
    "rest": (0.0235, 0.0068, 0.0008, 0.0016),
    "smile": (0.0275, 0.0095, 0.0010, 0.0115),
    "aa": (0.0190, 0.0020, 0.0035, 0.0150),
    "ih": (0.0220, 0.0030, 0.0020, 0.0060),
    "ou": (0.0095, 0.0000, 0.0035, 0.0055),
    "ee": (0.0245, 0.0045, 0.0022, 0.0045),
    "oh": (0.0125, 0.0000, 0.0060, 0.0100),
    "frown": (0.0200, -0.0040, 0.0009, 0.0012),
}
_MIDDLE = 1.5225  # y of the middle of the mouth, metres


def _mouth_points(shape: str) -> Array:
    half, corner, up, down = _MOUTHS[shape]
    u = np.sin(np.linspace(-0.5, 0.5, 21) * np.pi)
    line = _MIDDLE + corner * np.abs(u) ** 1.8
    bulge = np.sqrt(np.maximum(1.0 - u * u, 0.0))
    s = np.repeat([-1.0, -0.5, 0.0, 0.5, 1.0], len(u))
    y = np.tile(line, 5) + np.where(s > 0, up, down) * s * np.tile(bulge, 5)
    return _laid(np.column_stack([np.tile(half * u, 5), y]), np.full(len(y), 0.0006))


def mouth(colour: Array) -> Sheet:
    """A small smile; targets "smile", "frown" and the five vowels."""
    rest = _mouth_points("rest")
    targets = {name: _mouth_points(name) - rest for name in _MOUTHS if name != "rest"}
    return Sheet(sheet_mesh(rest, 5, 21, _FRONT), np.tile(colour, (len(rest), 1)), targets)


_SHOWN = {"smile": 1.0, "aa": 0.55, "ee": 0.8}  # how much of the upper teeth a shape of the mouth shows


def _teeth_points(shape: str) -> Array:
    half, corner, up, down = _MOUTHS[shape]
    shown = _SHOWN.get(shape, 0.0)
    u = np.sin(np.linspace(-0.5, 0.5, 13) * np.pi)
    line = _MIDDLE + corner * np.abs(u) ** 1.8
    bulge = np.sqrt(np.maximum(1.0 - u * u, 0.0)) * shown
    y = np.concatenate([line + 0.7 * up * bulge, line - 0.36 * down * bulge])
    return _laid(np.column_stack([np.tile(0.86 * half * u, 2), y]), np.full(len(y), 0.0009))


def teeth(colour: Array) -> Sheet:
    """The upper teeth, folded away at rest; the targets of `mouth`."""
    rest = _teeth_points("rest")
    targets = {name: _teeth_points(name) - rest for name in _MOUTHS if name != "rest"}
    mesh = sheet_mesh(_teeth_points("smile"), 2, 13, _FRONT)
    return Sheet(Mesh(rest, mesh.normals, mesh.triangles), np.tile(colour, (len(rest), 1)), targets)
