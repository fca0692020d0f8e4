"""The report's plots: rows of panels, one panel a scene."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.paper_table import PaperCell
from elbowroom.experiment.report.chart import Axis, Mark, Panel, Series, column, column_width, draw
from elbowroom.experiment.report.svg import label, points, tag, title
from elbowroom.experiment.table1.cells import Cell, Estimate
from elbowroom.experiment.table1.table import Table1

Floats = NDArray[np.float64]

FRAME_MS = 1e3 / 60.0
_PAPER = "paper"
_RATE = Axis(0.0, 1.0, ticks=(0.0, 0.5, 1.0), percent=True)


@dataclass(frozen=True)
class PlotRow:
    """A row of plots with its heading."""

    heading: str
    caption: str
    panels: tuple[str, ...]  # SVG elements


@dataclass(frozen=True)
class _Quantity:
    """Something to plot: ours and the paper's."""

    heading: str
    caption: str
    ours: Callable[[Cell], Estimate | None]
    papers: Callable[[PaperCell], float | None]
    form: str


_QUANTITIES = (
    _Quantity(
        "Crossed within the limit",
        "Share of all trials. Bars are 95 % Wilson intervals.",
        lambda cell: cell.pass_rate,
        lambda paper: paper.pass_rate,
        ".0%",
    ),
    _Quantity(
        "Crossed straight",
        "Share of all trials that got through without being stuck once.",
        lambda cell: cell.straight_rate,
        lambda paper: paper.straight_rate,
        ".0%",
    ),
    _Quantity(
        "Times stuck",
        "Mean over the crossings that succeeded, as in the paper, with its 95 % interval; no mark where none did.",
        lambda cell: cell.passed.stuck_times,
        lambda paper: paper.stuck_times,
        ".1f",
    ),
    _Quantity(
        "Collision checks for each local planning call",
        "Logarithmic. All checks, of root paths, local planning and shown frames, over all calls of the crossings that "
        "succeeded, with the 95 % bootstrap interval.",
        lambda cell: cell.passed.checks_per_plan,
        lambda paper: paper.checks_per_plan,
        ",.0f",
    ),
)


def figures(table: Table1) -> tuple[PlotRow, ...]:
    """All rows of plots."""
    return (*(_figure(table, quantity) for quantity in _QUANTITIES), _planning_times(table))


def scene_names(table: Table1) -> tuple[str, ...]:
    """The scenes in the order of the table."""
    return tuple(dict.fromkeys(cell.scene for cell in table.cells))


def scene_title(name: str) -> str:
    """What a panel is called."""
    return f"Scene {name.upper()}" if len(name) == 1 else name


def _figure(table: Table1, quantity: _Quantity) -> PlotRow:
    scenes = {name: _series(table, quantity, name) for name in scene_names(table)}
    axis = _axis(quantity, [series for row in scenes.values() for series in row])
    panels = [Panel(scene_title(name), table.settings.queues, axis, row) for name, row in scenes.items()]
    return PlotRow(quantity.heading, quantity.caption, tuple(draw(panel, quantity.heading) for panel in panels))


def _series(table: Table1, quantity: _Quantity, scene: str) -> tuple[Series, ...]:
    cells = [cell for cell in table.cells if cell.scene == scene]
    papers = {cell.queue_size: table.paper(cell) for cell in cells}
    theirs = [_paper_mark(queue, quantity, paper) for queue, paper in papers.items() if paper is not None]
    rows = [Series("paper", _PAPER, tuple(mark for mark in theirs if mark is not None))]
    for number, planner in enumerate(table.settings.planners):
        marks = [_own_mark(cell, quantity) for cell in cells if cell.planner == planner]
        rows.append(Series(planner, f"planner{number}", tuple(mark for mark in marks if mark is not None)))
    return tuple(rows)


def _paper_mark(queue: int, quantity: _Quantity, paper: PaperCell) -> Mark | None:
    value = quantity.papers(paper)
    return None if value is None else Mark(queue, value, note=format(value, quantity.form))


def _own_mark(cell: Cell, quantity: _Quantity) -> Mark | None:
    estimate = quantity.ours(cell)
    if estimate is None:
        return None
    known = math.isfinite(estimate.high)
    note = format(estimate.value, quantity.form)
    if known:
        note += f" ({format(estimate.low, quantity.form)} to {format(estimate.high, quantity.form)})"
    low, high = (estimate.low, estimate.high) if known else (None, None)
    return Mark(cell.queue_size, estimate.value, low, high, note)


def _axis(quantity: _Quantity, series: Sequence[Series]) -> Axis:
    if quantity.form.endswith("%"):
        return _RATE
    highest = max((mark.value for row in series for mark in row.marks), default=1.0)
    if not quantity.heading.startswith("Collision"):
        step = next((step for step in (1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if 4.0 * step >= highest), highest)
        top = max(highest, step)
        return Axis(0.0, top, ticks=tuple(np.arange(0.0, top + 0.01, step).tolist()))
    lowest = min((mark.value for row in series for mark in row.marks), default=1.0)
    return _log_axis(max(1.0, lowest), highest)


def _log_axis(lowest: float, highest: float) -> Axis:
    low = 10.0 ** math.floor(math.log10(lowest))
    high = 10.0 ** math.ceil(math.log10(max(highest, 10.0 * low)))
    decades = range(round(math.log10(low)), round(math.log10(high)) + 1)
    return Axis(low, high, log=True, ticks=tuple(10.0**power for power in decades))


def _planning_times(table: Table1) -> PlotRow:
    times = {(cell.planner, cell.scene, cell.queue_size): _plan_ms(table, cell) for cell in table.cells}
    known = np.concatenate([values for values in times.values() if len(values)] or [np.ones(1)])
    axis = _log_axis(max(0.1, float(known.min())), float(known.max()))
    panels = []
    for scene in scene_names(table):
        shapes = [_frame_line(axis)]
        for number, planner in enumerate(table.settings.planners):
            for queue in table.settings.queues:
                place = (table.settings.queues, queue, number, len(table.settings.planners))
                shapes.append(_violin(axis, place, planner, times[planner, scene, queue]))
        panels.append(Panel(scene_title(scene), table.settings.queues, axis, shapes=tuple(shapes)))
    heading = "Time of a planning call, milliseconds"
    caption = (
        "Logarithmic. Everything that the frame which planned had to do. Width is frequency; the bar is the median, "
        "the short line the 99th percentile, the ring the slowest call. The dashed line is one frame at 60 Hz."
    )
    return PlotRow(heading, caption, tuple(draw(panel, heading) for panel in panels))


def _plan_ms(table: Table1, cell: Cell) -> Floats:
    return np.array([value for trial in table.records(cell) for value in trial["plan_ms"]], np.float64)


def _frame_line(axis: Axis) -> str:
    y = axis.place(FRAME_MS)
    return tag("line", x1=38, x2=240, y1=y, y2=y, class_="limit") + label("1/60 s", 41.0, y - 3.0, class_="note")


def _violin(axis: Axis, place: tuple[Sequence[int], int, int, int], planner: str, values: Floats) -> str:
    """The distribution of some times as a shape; `place` is queue sizes, queue size, number of series, of how many."""
    queues, queue, number, count = place
    if not len(values):
        return ""
    width = 0.42 * column_width(queues) / count
    x = column(queues, queue) + (2.0 * number - count + 1.0) * width
    edges = np.linspace(math.log(axis.low), math.log(axis.high), 97)
    counts, _ = np.histogram(np.log(np.clip(values, axis.low, axis.high)), edges)
    density = np.convolve(counts, np.exp(-0.5 * (np.arange(-6, 7) / 2.0) ** 2), mode="same")
    used = np.flatnonzero(density > 0.004 * density.max())
    middles = np.exp(0.5 * (edges[:-1] + edges[1:]))[used]
    half = width * density[used] / density.max()
    ys = [axis.place(float(value)) for value in middles]
    outline = [(x - h, y) for h, y in zip(half, ys, strict=True)]
    outline += [(x + h, y) for h, y in zip(half[::-1], ys[::-1], strict=True)]
    median, p99 = (axis.place(float(np.percentile(values, share))) for share in (50, 99))
    worst = float(values.max())
    words = f"{planner}, |Q| {queue}: median {np.median(values):.1f} ms, 99 % {np.percentile(values, 99):.1f} ms, "
    parts = (
        title(f"{words}slowest {worst:.0f} ms, {len(values)} calls"),
        tag("polygon", points=points(outline), class_="violin"),
        tag("line", x1=x - 0.8 * width, x2=x + 0.8 * width, y1=median, y2=median, class_="median"),
        tag("line", x1=x - 0.4 * width, x2=x + 0.4 * width, y1=p99, y2=p99, class_="interval"),
        tag("circle", cx=x, cy=axis.place(worst), r=2.2, class_="worst"),
    )
    return tag("g", *parts, class_=f"series planner{number}")
