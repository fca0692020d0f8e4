"""Draws walks over low things from the side: `python tools/make_ground_pictures.py [FOLDER]`.

`ground.svg`: the stock avatar's capsules at even places of a walk over a sill, onto a kerb and up a ramp.
`stair.svg`: the same up a stair of four steps of 17 by 28 cm.
`climb.svg`: the same over a sill and a block of 40 cm.
"""

import math
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.control.controller import Controller
from elbowroom.experiment.report.svg import tag
from elbowroom.planning.command import Command
from elbowroom.planning.model.highest_step import as_climbed
from elbowroom.world.ground.ground import height_along
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
SCALE, TOP, FRAMES = 110.0, 2.6, 60  # pixels a metre, metres that are drawn, frames a second
GROUND, LEFT, RIGHT, TRUNK = "#8a8f96", "#c8511b", "#2c6f93", "#d9b38c"


class Walk(NamedTuple):
    """A walk that is drawn."""

    things: list[dict[str, Any]]
    end: float  # metres that are walked
    apart: float  # metres between two bodies

    @property
    def scene(self) -> Scene:
        """Where it is."""
        return Scene.of("ground", self.things, finish=(0.0, self.end))


def box(begin: float, top: float, length: float) -> dict[str, Any]:
    """Something low right across the way."""
    return {"type": "box", "center": [0.0, 0.5 * top, begin + 0.5 * length], "size": [3.0, top, length]}


def low_things() -> Walk:
    """Over a sill, a kerb and up a ramp."""
    rise = 1.8 * math.tan(math.radians(15.0))
    wedge = [[x, y, z] for x in (-1.5, 1.5) for y, z in ((0.0, 0.0), (0.0, 1.8), (rise, 1.8))]
    ramp = {"type": "hull", "points": wedge, "center": [0.0, 0.0, 6.0]}
    return Walk([box(1.4, 0.2, 0.1), box(2.9, 0.15, 1.6), ramp, box(7.8, rise, 4.0)], 9.6, 0.62)


def stair() -> Walk:
    """Up four steps."""
    steps = [box(1.2 + 0.28 * i, 0.17 * (i + 1), 0.28) for i in range(4)]
    return Walk([*steps, box(1.2 + 0.28 * 4, 0.17 * 4, 3.0)], 4.4, 0.42)


def high_things() -> Walk:
    """Over what is too high for a step."""
    return Walk([box(1.4, 0.4, 0.1), box(3.4, 0.4, 0.9)], 5.4, 0.42)


def walked(walk: Walk, scene: Scene) -> list[tuple[Floats, Floats]]:
    """Postures and root states, one every so many metres of the way."""
    controller, shown, at = Controller(Humanoid.default(), scene), [], 0.0
    for _ in range(60 * FRAMES):
        frame = controller.step(Command(forward=1.0), 1.0 / FRAMES)
        if frame.root[1] >= at:
            shown.append((frame.q, frame.root))
            at += walk.apart
        if scene.finished(controller.root):
            break
    return shown


def drawn(walk: Walk) -> str:
    """The picture as SVG."""
    humanoid, scene = Humanoid.default(), walk.scene
    model, names = body_model(humanoid), humanoid.capsules.names
    parts = []
    for q, root in walked(walk, scene):
        axes = posture_capsules(model, q, root)[:, :, 0]
        for c in np.argsort(-axes[:, 0]):
            color = LEFT if names[c].startswith("left") else RIGHT if names[c].startswith("right") else TRUNK
            y1, x1, y2, x2 = (float(value) for value in axes[c, [1, 2, 4, 5]])
            ends = {"x1": across(x1), "y1": up(y1), "x2": across(x2 + 1e-3), "y2": up(y2)}
            width = 2.0 * SCALE * float(humanoid.capsules.radii[c])
            parts.append(tag("line", **ends, stroke=color, stroke_width=width, stroke_linecap="round"))
    heights, near, ground = [], 0.0, (as_climbed(scene, humanoid) or scene).ground
    ways = np.arange(-0.5, walk.end + 0.5, 0.01).tolist()
    for z in ways:
        near = height_along(ground, (0.0, near, z - 0.01), 0.0, z)
        heights.append(near)
    edge = " ".join(f"{across(z)},{up(y)}" for z, y in zip(ways, heights, strict=True))
    below = f"{across(ways[-1])},{up(-0.12)} {across(ways[0])},{up(-0.12)}"
    parts.append(tag("polygon", points=f"{edge} {below}", fill=GROUND))
    wide, high = across(walk.end + 0.5), up(-0.12)
    return tag("svg", *parts, xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {wide} {high}")


def across(z: float) -> str:
    """A place along the way in the picture."""
    return f"{SCALE * (z + 0.5):.1f}"


def up(y: float) -> str:
    """A height in the picture."""
    return f"{SCALE * (TOP - y):.1f}"


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    for name, walk in {"ground": low_things(), "stair": stair(), "climb": high_things()}.items():
        (folder / f"{name}.svg").write_text(drawn(walk) + "\n", "utf-8")
