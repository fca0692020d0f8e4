"""A scene from above and from the side, with a crossing drawn in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.report.crossings import DrawnCrossing
from elbowroom.experiment.report.svg import points, tag, title
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_MARGIN = 0.3  # metres around what is drawn


@dataclass(frozen=True, eq=False)
class _View:
    """A direction to look from: rows map a point relative to the start to (right, down, towards the viewer)."""

    matrix: Floats  # (3, 3)
    origin: Floats  # (3,)
    name: str

    def see(self, places: Floats) -> Floats:
        """Points (..., 3) of the world as (..., 3) right, down, towards the viewer."""
        seen: Floats = (places - self.origin) @ self.matrix.T
        return seen


@dataclass(frozen=True, eq=False)
class _Drawing:
    """What is to be seen from one side."""

    scene: Scene
    crossing: DrawnCrossing | None
    view: _View


def draw_scenes(scenes: Sequence[Scene], crossings: Mapping[str, DrawnCrossing]) -> list[tuple[str, str]]:
    """Two SVG elements for each scene: from above, and from the avatar's right side.

    The way ahead points to the right in all, and all have the same scale.
    """
    pictures: list[list[str]] = [[], []]
    for number, look in enumerate((_above, _beside)):
        drawings = [_Drawing(scene, crossings.get(scene.name), look(scene)) for scene in scenes]
        bounds = np.array([_bounds(drawing) for drawing in drawings])
        low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
        pictures[number] = [_drawn(drawing, low, high) for drawing in drawings]
    return list(zip(*pictures, strict=True))


def _above(scene: Scene) -> _View:
    ahead, left, up = _axes(scene)
    return _View(np.array([ahead, -left, up]), _start(scene), "from above")


def _beside(scene: Scene) -> _View:
    ahead, left, up = _axes(scene)
    return _View(np.array([ahead, -up, -left]), _start(scene), "from the side")


def _axes(scene: Scene) -> tuple[Floats, Floats, Floats]:
    """The directions ahead, left and up of who stands at the start."""
    sine, cosine = np.sin(scene.start.heading), np.cos(scene.start.heading)
    return np.array([sine, 0.0, cosine]), np.array([cosine, 0.0, -sine]), np.array([0.0, 1.0, 0.0])


def _start(scene: Scene) -> Floats:
    return np.array([scene.start.x, 0.0, scene.start.z])


def _drawn(drawing: _Drawing, low: Floats, high: Floats) -> str:
    """Everything between two corners of the picture, from far to near."""
    from scipy.spatial import ConvexHull  # slow to import, and drawn last

    scene, crossing, view = drawing.scene, drawing.crossing, drawing.view
    layers: list[tuple[float, str]] = []
    for name, corners in scene.obstacles.outlines:
        seen = view.see(corners)
        hull = seen[ConvexHull(seen[:, :2]).vertices, :2]
        shape = tag("polygon", title(name), points=points((x, y) for x, y in hull.tolist()), class_="obstacle")
        layers.append((float(seen[:, 2].max()), shape))
    if crossing is not None:
        figures = "".join(_figure(crossing, posture, view) for posture in crossing.postures)
        layers.append((float(view.see(_middle(crossing))[2]), figures + _way(crossing, view)))
    parts = [shape for _, shape in sorted(layers, key=lambda layer: layer[0])]
    box = f"{low[0]:.3g} {low[1]:.3g} {high[0] - low[0]:.3g} {high[1] - low[1]:.3g}"
    words = title(f"{scene.title}, {view.name}")
    around = (_ground(low, high, view), *parts, _gate(scene, low, high, view))
    return tag("svg", words, *around, viewBox=box, role="img", class_="scene")


def _middle(crossing: DrawnCrossing) -> Floats:
    """The middle of the body on its way, at the height of the elbows."""
    x, z = crossing.roots.mean(axis=0)
    return np.array([x, 1.0, z])


def _figure(crossing: DrawnCrossing, posture: Floats, view: _View) -> str:
    """One posture (C, 6): capsules, each a thick line, from far to near."""
    starts, ends = view.see(posture[:, :3]), view.see(posture[:, 3:])
    order = np.argsort(starts[:, 2] + ends[:, 2])
    lines = [
        tag(
            "line",
            x1=float(starts[i, 0]),
            y1=float(starts[i, 1]),
            x2=float(ends[i, 0]) + 1e-4,
            y2=float(ends[i, 1]),
            stroke_width=2.0 * float(crossing.radii[i]),
            class_=crossing.groups[i].label,
        )
        for i in order
    ]
    return tag("g", *lines, class_="posture")


def _way(crossing: DrawnCrossing, view: _View) -> str:
    """The root's way on the ground, and where it got stuck."""
    seen = view.see(_on_ground(crossing.roots))
    stuck = view.see(_on_ground(crossing.stuck_at))
    rings = [tag("circle", title("stuck here"), cx=x, cy=y, r=0.055, class_="stuck") for x, y, _ in stuck.tolist()]
    way = tag("polyline", points=points((x, y) for x, y, _ in seen[::4].tolist()), class_="way")
    return way + "".join(rings)


def _gate(scene: Scene, low: Floats, high: Floats, view: _View) -> str:
    """The finish, as a line across the picture."""
    x = float(view.see(_on_ground(np.array([scene.finish.position])))[0, 0])
    return tag("line", title("finish"), x1=x, x2=x, y1=float(low[1]), y2=float(high[1]), class_="gate")


def _ground(low: Floats, high: Floats, view: _View) -> str:
    """The ground as a line; from above it is everywhere."""
    if view.matrix[1, 1] == 0.0:
        return ""
    return tag("line", x1=float(low[0]), x2=float(high[0]), y1=0.0, y2=0.0, class_="ground")


def _bounds(drawing: _Drawing) -> tuple[Floats, Floats]:
    """Two corners with everything between them."""
    scene, crossing, view = drawing.scene, drawing.crossing, drawing.view
    shown = [scene.obstacles.corners.reshape(-1, 3), _start(scene)[None], _on_ground(np.array([scene.finish.position]))]
    if crossing is not None:
        shown.append(crossing.postures.reshape(-1, 3))
    seen = view.see(np.concatenate(shown))[:, :2]
    return seen.min(axis=0) - _MARGIN, seen.max(axis=0) + _MARGIN


def _on_ground(places: Floats) -> Floats:
    """Points (n, 2) x, z as (n, 3)."""
    x, z = places.reshape(-1, 2).T
    return np.stack([x, np.zeros(len(x)), z], axis=1)
