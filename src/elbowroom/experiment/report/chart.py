"""One small plot: values over queue sizes, ours with intervals, the paper's beside them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from elbowroom.experiment.report.svg import label, points, tag, title

WIDTH, HEIGHT = 248.0, 168.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 38.0, 8.0, 24.0, 28.0


@dataclass(frozen=True)
class Axis:
    """The vertical axis."""

    low: float
    high: float
    log: bool = False
    ticks: tuple[float, ...] = ()
    percent: bool = False

    def place(self, value: float) -> float:
        """Where a value lies, pixels from the top; values beyond an end lie on it."""
        inside = min(max(value, self.low), self.high)
        if self.log:
            part = math.log(inside / self.low) / math.log(self.high / self.low)
        else:
            part = (inside - self.low) / (self.high - self.low)
        return HEIGHT - _BOTTOM - part * (HEIGHT - _TOP - _BOTTOM)

    def text(self, value: float) -> str:
        """A tick's name."""
        if self.percent:
            return f"{100.0 * value:.0f} %"
        thousands = value >= 1e3 and value % 1e3 == 0.0
        return f"{value / 1e3:g}k" if thousands else f"{value:g}"


@dataclass(frozen=True)
class Mark:
    """A value at one queue size; `low` and `high` bound its interval."""

    queue: int
    value: float
    low: float | None = None
    high: float | None = None
    note: str = ""


@dataclass(frozen=True)
class Series:
    """Marks joined by a line. `kind` is its CSS class: "paper", or "planner0", "planner1" ..."""

    name: str
    kind: str
    marks: tuple[Mark, ...]


@dataclass(frozen=True)
class Panel:
    """A plot for one scene."""

    name: str
    queues: tuple[int, ...]
    axis: Axis
    series: tuple[Series, ...] = ()
    shapes: tuple[str, ...] = field(default=())  # what else is drawn, behind the series

    def column(self, queue: int) -> float:
        """The middle of a queue size's column, pixels from the left."""
        return column(self.queues, queue)


def column(queues: Sequence[int], queue: int) -> float:
    """The middle of a queue size's column, pixels from the left."""
    return _LEFT + (queues.index(queue) + 0.5) * column_width(queues)


def column_width(queues: Sequence[int]) -> float:
    """The width of a column in pixels."""
    return (WIDTH - _LEFT - _RIGHT) / len(queues)


def draw(panel: Panel, about: str) -> str:
    """The panel as an SVG element; `about` is what it shows, in words."""
    parts = [title(f"{about}, {panel.name}"), *_frame(panel), *panel.shapes]
    shift = min(9.0, 0.5 * column_width(panel.queues) / max(1, len(panel.series)))
    for place, series in enumerate(panel.series):
        parts += _drawn(panel, series, (place - 0.5 * (len(panel.series) - 1)) * shift)
    return tag("svg", *parts, viewBox=f"0 0 {WIDTH:g} {HEIGHT:g}", role="img", class_="plot")


def _frame(panel: Panel) -> list[str]:
    axis, right = panel.axis, WIDTH - _RIGHT
    parts = [label(panel.name, _LEFT, 13.0, class_="panel")]
    for tick in axis.ticks:
        y = axis.place(tick)
        parts.append(tag("line", x1=_LEFT, x2=right, y1=y, y2=y, class_="grid"))
        parts.append(label(axis.text(tick), _LEFT - 6.0, y + 3.5, class_="tick", text_anchor="end"))
    for queue in panel.queues:
        parts.append(
            label(str(queue), panel.column(queue), HEIGHT - _BOTTOM + 15.0, class_="tick", text_anchor="middle")
        )
    return parts


def _drawn(panel: Panel, series: Series, shift: float) -> list[str]:
    places = [(panel.column(mark.queue) + shift, panel.axis.place(mark.value)) for mark in series.marks]
    parts = [tag("polyline", points=points(places), class_="line")] if len(places) > 1 else []
    for mark, (x, y) in zip(series.marks, places, strict=True):
        if mark.low is not None and mark.high is not None:
            ends = panel.axis.place(mark.low), panel.axis.place(mark.high)
            parts.append(tag("line", x1=x, x2=x, y1=ends[0], y2=ends[1], class_="interval"))
        words = f"{series.name}, |Q| {mark.queue}: {mark.note or panel.axis.text(mark.value)}"
        parts.append(tag("circle", title(words), cx=x, cy=y, r=3.6, class_="mark"))
    return [tag("g", *parts, class_=f"series {series.kind}")]
