"""One walk from above: what stands there, the way of the root, where it was near something."""

import json
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from elbowroom.errors import InputError
from elbowroom.experiment.report.svg import points, tag, title
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_MARGIN = 0.6  # metres around the way
_NEAR = 0.05  # metres to the nearest obstacle that are told by colour


def plan(document: str, root: Floats, clearance: Floats, about: str) -> str:
    """An SVG element of a walk: its scene as JSON, root states (F, 7), clearances (F,).

    +X points left and +Z up, as who sets out sees it. What a model of a place holds is not in its scene, and not drawn.
    """
    seen = -root[:, :2]
    low, high = seen.min(axis=0) - _MARGIN, seen.max(axis=0) + _MARGIN
    size = max(float((high - low).max()), 3.0)
    middle = 0.5 * (low + high)
    corner = middle - 0.5 * size
    parts = [tag("polygon", title(name), points=points(hull), class_="obstacle") for name, hull in _standing(document)]
    for first, last, near in _stretches(clearance < _NEAR):
        places = points((float(x), float(y)) for x, y in seen[first : last + 1])
        parts.append(tag("polyline", points=places, class_="near" if near else "way"))
    x, y = seen[0].tolist()
    parts.append(tag("circle", title("start"), cx=float(x), cy=float(y), r=0.02 * size, class_="start"))
    box = f"{corner[0]:.4g} {corner[1]:.4g} {size:.4g} {size:.4g}"
    return tag("svg", title(about), *parts, viewBox=box, role="img", class_="scene")


def _standing(document: str) -> list[tuple[str, list[tuple[float, float]]]]:
    """Names and outlines, seen from above, of what stands in a scene; empty where its model is not at hand."""
    try:
        scene = Scene.from_dict(json.loads(document))
    except InputError:
        return []
    found = []
    for name, corners in scene.obstacles.outlines:
        flat = -corners[:, [0, 2]]
        found.append((name, [(float(x), float(z)) for x, z in flat[ConvexHull(flat).vertices]]))
    return found


def _stretches(flags: NDArray[np.bool_]) -> list[tuple[int, int, bool]]:
    """Rows of equal flags: first, last (the first of the next, but for the end), flag."""
    ends = [0, *(np.flatnonzero(np.diff(flags)) + 1).tolist(), len(flags) - 1]
    return [(first, last, bool(flags[first])) for first, last in pairwise(ends)]
