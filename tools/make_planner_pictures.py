"""Draws the planner's tables as they are: `python tools/make_planner_pictures.py [FOLDER]`.

`slice-table.svg`: the left arm's postures at the key times of a plan through scene D, which are free and what they
cost, and the way through them. `joint-step.svg`: a slice where the groups one after the other found no way, and all
together did.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import SEARCH_ORDER, DofGroup, columns_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.experiment.report.svg import label, points, tag
from elbowroom.planning.exact.joint.step import PRODUCT, JointStep
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperBodySearch
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
INTERVAL, SPEED = 0.15, 1.1  # seconds, m/s
OTHERWISE = 0.2  # radians between two waists that are not the same
TRIES = 400  # random scenes in which the joint step is looked for
FEW = 16  # waists: as many rows are told apart
CLOSED, FREE_NEAR, FREE_FAR, WAY, OTHER = "#3b3f46", (226, 240, 217), (88, 140, 96), "#c8511b", "#2c6f93"
STYLE = "font: 13px sans-serif; fill: #333"


def walk(horizon: int, begin: float) -> RootPath:
    """Straight on along +Z from `begin`."""
    states, times = np.zeros((horizon + 1, ROOT_STATE)), INTERVAL * np.arange(horizon + 1.0)
    states[:, 1], states[:, 3], states[:, 6] = begin + SPEED * times, SPEED, 0.9 * times
    return RootPath(0.0, INTERVAL, states)


def dressing_of(body: UpperBodyPlanner, path: RootPath) -> UpperBodySearch:
    """A plan's dressing along a path that begins in the natural walk; nothing searched yet."""
    start = body.model.goals(path)[0]
    return body.plan(path, StartState(start, np.zeros_like(start)), effort=Effort.JOINT).search


def shade(share: float) -> str:
    """The colour of a free posture: the farther from the goal, the darker."""
    mixed = (round(a + (b - a) * share) for a, b in zip(FREE_NEAR, FREE_FAR, strict=True))
    return "#" + "".join(f"{part:02x}" for part in mixed)


def cells(free: NDArray[np.bool_], shades: Floats, x: float, y: float, size: tuple[float, float]) -> str:
    """A table (rows, columns) of little boxes; closed ones are dark."""
    wide, high = size
    parts = []
    for i in range(free.shape[0]):
        steps = np.round(shades[i] * 5.0) / 5.0
        colours = [shade(float(step)) if ok else CLOSED for ok, step in zip(free[i], steps, strict=True)]
        begin = 0
        for j in range(1, len(colours) + 1):
            if j == len(colours) or colours[j] != colours[begin]:
                place = {"x": round(x + begin * wide, 1), "y": round(y + i * high, 1)}
                parts.append(tag("rect", **place, width=round((j - begin) * wide, 1), height=high, fill=colours[begin]))
                begin = j
    return "".join(parts)


def picture(width: float, height: float, *parts: str) -> str:
    """A whole drawing on white."""
    ground = tag("rect", width=width, height=height, fill="#ffffff")
    return tag(
        "svg", ground, *parts, xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {width:g} {height:g}",
        width=width, height=height, style=STYLE,
    )  # fmt: skip


def slice_table(humanoid: Humanoid) -> str:
    """Left arm in scene D: key times across, postures down, the nearest to hanging on top."""
    body, path = UpperBodyPlanner(humanoid, Scene.load("d"), ExactSettings()), walk(16, 0.4)
    dressing = dressing_of(body, path)
    ways = dressing.apart().paths
    way = ways[SEARCH_ORDER.index(DofGroup.LEFT_ARM)]
    points_of = dressing.caches.group(DofGroup.LEFT_ARM).postures.configurations
    goals = dressing.goals[:, columns_of(DofGroup.LEFT_ARM)]
    order = np.argsort(np.linalg.norm(points_of - goals[0], axis=1))
    free = np.isfinite(way.cost[:, order]).T
    cost = np.where(free, way.cost[:, order].T, 0.0).astype(np.float64)
    wide, high, left, top = 34.0, 2.2, 70.0, 46.0
    body_of_table = cells(free, np.clip(cost / 3.0, 0.0, 1.0), left, top, (wide, high))
    nearest = [int(np.argmin(np.linalg.norm(points_of[order] - key, axis=1))) for key in way.keys]
    line = points((left + (t + 0.5) * wide, top + (row + 0.5) * high) for t, row in enumerate(nearest))
    bottom = top + high * len(order)
    ticks = [
        label(f"{INTERVAL * t:.1f} s", left + (t + 0.5) * wide, bottom + 18, text_anchor="middle")
        for t in range(0, len(way.keys), 2)
    ]
    return picture(
        left + wide * len(way.keys) + 20, bottom + 34,
        label(f"Left arm, scene D: {len(order)} postures at {len(way.keys)} key times", left, 24),
        body_of_table,
        tag("polyline", points=line, fill="none", stroke=WAY, stroke_width=2.5),
        label("near", 14, top + 12), label("the goal", 14, top + 28), label("far", 14, bottom - 4), *ticks,
    )  # fmt: skip


def random_scene(seed: int) -> Scene:
    """Boxes on both sides of a walk, at the height of arms and shoulders."""
    rng = np.random.default_rng(seed)
    count = 5
    side = rng.choice([-1.0, 1.0], count)
    centers = np.stack(
        [side * rng.uniform(0.2, 0.45, count), rng.uniform(0.8, 1.6, count), rng.uniform(0.8, 1.6, count)]
    )
    boxes = Obstacles.boxes(centers.T, np.tile([0.0, 0.0, 0.0, 1.0], (count, 1)), rng.uniform(0.04, 0.16, (count, 3)))
    return replace(Scene.load("empty"), obstacles=boxes)


def _differs(waist: Floats, dressing: UpperBodySearch, depth: int) -> bool:
    """Whether a waist (3,) is another than the one that the waist's own search has at a key time."""
    return float(np.linalg.norm(waist - dressing.waist_at(depth))) > OTHERWISE


def failed_alone(humanoid: Humanoid) -> tuple[UpperBodySearch, JointStep, NDArray[np.int64]]:
    """The first random scene where an arm has no way under the waist's, and under one of a few others has; and that."""
    path = walk(12, 0.0)
    for seed in range(TRIES):
        dressing = dressing_of(UpperBodyPlanner(humanoid, random_scene(seed), ExactSettings()), path)
        alone = dressing.apart()
        if alone.failed is None or not alone.paths:
            continue
        step = dressing.joint_step()
        answer = step.search()
        depth = dressing.blocked[1]
        if len(answer.nodes) and _differs(step.configurations(0, depth)[answer.nodes[depth, 0]], dressing, depth):
            step.fill(depth, np.ones(step.filled.shape[1], np.bool_))
            if np.isfinite(step.nodes[0].base[depth]).sum() <= FEW:
                return dressing, step, answer.nodes
    raise SystemExit(f"no scene of {TRIES} needs the joint step")


def joint_picture(humanoid: Humanoid) -> str:
    """The blocked slice: waists down, postures of the left and of the right arm across."""
    dressing, step, nodes = failed_alone(humanoid)
    depth = dressing.blocked[1]
    rows = np.flatnonzero(np.isfinite(step.nodes[0].base[depth]))
    rows = rows[np.argsort(step.nodes[0].base[depth, rows], kind="stable")]
    assert dressing.blocked[0] > 0
    chosen = int(np.flatnonzero(rows == nodes[depth, 0])[0])
    known = step.configurations(0, depth)[rows]
    waist = dressing.waist_at(depth)
    alone = int(np.argmin(np.linalg.norm(known - waist, axis=1)))
    wide, high, left, top = 2.0, 12.0, 150.0, 62.0
    parts, x = [], left
    for side, name in enumerate(("left arm", "right arm")):
        prices = step.costs[side][depth, rows]
        alone_costs = step.nodes[PRODUCT[1 + side]].costs_alone[depth]
        columns = np.flatnonzero(np.isfinite(alone_costs))
        columns = columns[np.argsort(alone_costs[columns], kind="stable")]
        free = np.isfinite(prices[:, columns])
        cost = np.where(free, prices[:, columns], 0.0).astype(np.float64)
        parts += [cells(free, np.clip(cost / 3.0, 0.0, 1.0), x, top, (wide, high)), label(name, x, top - 10)]
        at = int(np.flatnonzero(columns == nodes[depth, 1 + side])[0])
        place = x + (at + 0.5) * wide, top + (chosen + 0.5) * high
        parts.append(tag("circle", cx=place[0], cy=place[1], r=5.0, fill="none", stroke=WAY, stroke_width=2.5))
        x += wide * len(columns) + 30
    for row, text, colour in ((alone, "waist alone", OTHER), (chosen, "all together", WAY)):
        y = top + (row + 0.5) * high
        parts.append(label(text, left - 12, y + 4, text_anchor="end", fill=colour))
        parts.append(tag("line", x1=left - 8, x2=x - 30, y1=y, y2=y, stroke=colour, stroke_width=1.5))
    heading = f"Key time {depth}: {len(rows)} free waist postures, the cheapest on top, and the arms under each"
    return picture(x, top + high * len(rows) + 20, label(heading, 14, 24), *parts)


def main(folder: Path) -> None:
    """Write both pictures."""
    humanoid = Humanoid.default()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "slice-table.svg").write_text(slice_table(humanoid), encoding="utf-8")
    (folder / "joint-step.svg").write_text(joint_picture(humanoid), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
