"""The report's tables."""

import math
from collections.abc import Sequence

from elbowroom.experiment.report.svg import tag
from elbowroom.experiment.table1.cells import Cell, Estimate, scene_label
from elbowroom.experiment.table1.columns import our_texts, paper_texts
from elbowroom.experiment.table1.table import Table1

_BESIDE = ("crossed", "straight", "stuck", "time, s", "calls", "found", "checks a call", "real time")
_ALL = ("trials", "crossed", "straight", "times stuck", "time, s", "calls", "checks a call", "of these local")


def comparison_table(table: Table1) -> str:
    """Ours and the paper's figures side by side."""
    heads = [tag("th", name, colspan=2) for name in _BESIDE]
    more = [tag("th", name) for name in ("late", "frame 99 %, ms", "slowest, ms")]
    head = tag("tr", tag("th", "scene"), tag("th", "|Q|"), *heads, *more)
    rows = []
    for cell in table.cells:
        paper = table.paper(cell)
        theirs = paper_texts(paper, _written) if paper is not None else [""] * len(_BESIDE)
        pairs = zip(our_texts(cell, _written), theirs, strict=True)
        beside = [tag("td", ours) + tag("td", paper, class_="paper") for ours, paper in pairs]
        late = f"{cell.late_frames:,}".replace(",", " ")
        times = [tag("td", text) for text in (late, f"{cell.frame_ms.p99:.1f}", f"{cell.frame_ms.worst:.0f}")]
        rows.append(_row(table, cell, [*beside, *times]))
    return _table(head, rows)


def everything_table(table: Table1) -> str:
    """Averages over all trials with their intervals."""
    head = tag("tr", tag("th", "scene"), tag("th", "|Q|"), *(tag("th", name) for name in _ALL))
    rows = []
    for cell in table.cells:
        texts = (
            str(cell.trials),
            _bounded(cell.pass_rate, ".2f"),
            _bounded(cell.straight_rate, ".2f"),
            _bounded(cell.all.stuck_times, ".1f"),
            _bounded(cell.all.time_s, ".1f"),
            _bounded(cell.all.plans_total, ".0f"),
            _bounded(cell.all.checks_per_plan, ".0f"),
            _bounded(cell.all.local_checks_per_plan, ".0f"),
        )
        rows.append(_row(table, cell, [tag("td", text) for text in texts]))
    return _table(head, rows)


def canned_table(table: Table1) -> str:
    """What the walk without planning touches."""
    names = ("scene", "walks", "of these touch", "frames that touch", "of all frames", "deepest, cm")
    rows = []
    for cell in table.canned:
        texts = (
            str(cell.trials),
            str(cell.touching_trials),
            str(cell.touching_frames),
            f"{cell.share:.0%}",
            f"{100.0 * cell.deepest:.1f}",
        )
        rows.append(tag("tr", tag("th", scene_label(cell.scene)), *(tag("td", text) for text in texts)))
    return _table(tag("tr", *(tag("th", name) for name in names)), rows)


def _table(head: str, rows: Sequence[str]) -> str:
    return tag("div", tag("table", tag("thead", head), tag("tbody", *rows)), class_="scroll")


def _row(table: Table1, cell: Cell, cells: Sequence[str]) -> str:
    first = cell.queue_size == table.settings.queues[0]
    name = scene_label(cell.scene) if first else ""
    if first and len(table.settings.planners) > 1:
        name += f" {cell.planner}"
    return tag("tr", tag("th", name), tag("th", str(cell.queue_size)), *cells, class_="first" if first else None)


def _written(value: float | None, form: str) -> str:
    return "–" if value is None else _spaced(format(value, form.replace(".0f", ",.0f")))


def _value(estimate: Estimate | None, form: str) -> str:
    return _written(None if estimate is None else estimate.value, form)


def _bounded(estimate: Estimate | None, form: str) -> str:
    text = _value(estimate, form)
    if estimate is None or not math.isfinite(estimate.high):
        return text
    ends = f"{_written(estimate.low, form)} to {_written(estimate.high, form)}"
    return text + tag("small", ends)


def _spaced(number: str) -> str:
    """Thousands apart by a narrow space."""
    return number.replace(",", "\u202f")
