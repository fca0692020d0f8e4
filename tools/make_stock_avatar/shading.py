"""Soft shade in creases (vertex colours), measured on the clay, and a little warmth on the skin."""

import numpy as np

from make_stock_avatar import clothes
from make_stock_avatar.fields import Array, Field, mirrored
from make_stock_avatar.hand import arm
from make_stock_avatar.head import head
from make_stock_avatar.polygonise import Mesh


def figure(p: Array) -> Array:
    """All the clay of the figure but the hair."""
    q = mirrored(p)
    parts: tuple[Field, ...] = (clothes.shirt, clothes.trousers, clothes.shoe, arm, head)
    result = np.full(len(p), np.inf)
    for part in parts:
        result = np.minimum(result, part(q))
    return result


def open_sky(mesh: Mesh, surroundings: Field, reach: tuple[float, ...] = (0.008, 0.02, 0.045)) -> Array:
    """How open each vertex lies, (V,) in 0..1: 1 where nothing is within reach above the surface."""
    shade = np.zeros(len(mesh.points))
    for distance in reach:
        free = surroundings(mesh.points + mesh.normals * distance)
        shade += np.clip(1.0 - free / distance, 0.0, 1.0) / len(reach)
    return np.asarray(1.0 - shade)


def tinted(mesh: Mesh, surroundings: Field, depth: float, warmth: Array) -> Array:
    """Vertex colours (V, 3): white in the open, towards `warmth` in the creases."""
    closed = (1.0 - open_sky(mesh, surroundings))[:, None] * depth
    return np.asarray((1.0 - closed) + closed * warmth)


def blush(points: Array, colours: Array) -> Array:
    """Rosy cheeks, nose, ears, lips and finger tips, multiplied onto colours (V, 3)."""
    q = mirrored(points)
    amount = np.zeros(len(points))
    for centre, radius, strength in (
        ((0.044, 1.555, 0.070), 0.026, 0.75),
        ((0.0, 1.560, 0.106), 0.016, 0.5),
        ((0.083, 1.583, -0.014), 0.03, 0.6),
        ((0.0, 1.521, 0.088), 0.014, 0.5),
    ):
        near = np.clip(1.0 - np.linalg.norm(q - np.array(centre), axis=1) / radius, 0.0, 1.0)
        amount = np.maximum(amount, strength * near * near * (3 - 2 * near))
    tips = np.clip((q[:, 0] - 0.80) / 0.08, 0.0, 1.0) * 0.35
    amount = np.maximum(amount, tips)[:, None]
    return np.asarray(colours * (1.0 - amount * np.array([0.03, 0.40, 0.38])))
