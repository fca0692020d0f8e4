"""Table 1 for a terminal: ours and the paper's figures side by side."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

from elbowroom.experiment.paper_table import PaperCell, paper_table
from elbowroom.experiment.table1.cells import CannedCell, Cell, Estimate, scene_label
from elbowroom.experiment.table1.columns import our_texts, paper_texts
from elbowroom.experiment.table1.table import Table1

_WIDTH = 118  # characters: of the widest table

_PAIRS = ("pass", "straight", "stuck", "time s", "plans", "found", "checks/plan", "real time")


def print_table1(table: Table1, about: Mapping[str, Any], files: Sequence[str]) -> None:
    """The three tables on stdout, and where the files are."""
    console = Console()
    if console.width < _WIDTH:
        console = Console(width=_WIDTH)
    for planner in table.settings.planners:
        cells = [cell for cell in table.cells if cell.planner == planner]
        console.print(_beside_paper(table, planner, cells))
        console.print(_over_all(planner, cells))
        console.print(_times(planner, cells))
    console.print(_canned(table.canned))
    console.print(f"{about['date']}, {about['machine']}, {about['settings']['jobs']} at once", highlight=False)
    console.print("  ".join(files), highlight=False, soft_wrap=True)


def _beside_paper(table: Table1, planner: str, cells: Sequence[Cell]) -> Table:
    view = _table(f"{planner}: averages over crossings that succeeded, each with the paper's figure in grey")
    view.add_column("scene")
    view.add_column("|Q|", justify="right")
    for name in (*_PAIRS, "late"):
        view.add_column(name, justify="right", no_wrap=True)
    for place, cell in enumerate(cells):
        view.add_row(*_row(cell, table.paper(cell)), end_section=_is_last(place, cells))
    return view


def _row(cell: Cell, paper: PaperCell | None) -> list[str]:
    ours = our_texts(cell, _plain)
    theirs = [""] * len(ours) if paper is None else paper_texts(paper, _plain)
    widths = [max(len(text) for text in _papers_texts(place)) for place in range(len(ours))]
    beside = [f"{our} [dim]{text:>{width}}[/]" for our, text, width in zip(ours, theirs, widths, strict=True)]
    return [scene_label(cell.scene), str(cell.queue_size), *beside, str(cell.late_frames)]


def _papers_texts(place: int) -> list[str]:
    """One column of the paper's table."""
    return [paper_texts(paper, _plain)[place] for paper in paper_table().values()]


def _plain(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)


def _over_all(planner: str, cells: Sequence[Cell]) -> Table:
    view = _table(
        f"{planner}: over all trials, with 95 % intervals; a crossing that failed counts with the whole limit"
    )
    view.add_column("scene")
    for name in ("|Q|", "trials", "pass", "straight", "stuck", "time s", "checks/plan"):
        view.add_column(name, justify="right", no_wrap=True)
    for place, cell in enumerate(cells):
        texts = (
            _bounded(cell.pass_rate, ".2f"),
            _bounded(cell.straight_rate, ".2f"),
            _bounded(cell.all.stuck_times, ".1f"),
            _bounded(cell.all.time_s, ".1f"),
            _bounded(cell.all.checks_per_plan, ".0f"),
        )
        first = (scene_label(cell.scene), str(cell.queue_size), str(cell.trials))
        view.add_row(*first, *texts, end_section=_is_last(place, cells))
    return view


def _times(planner: str, cells: Sequence[Cell]) -> Table:
    view = _table(f"{planner}: milliseconds that frames took, and of these the ones that planned")
    view.add_column("scene")
    for name in ("|Q|", "frames", "99 %", "worst", "late", "plans", "median", "99 %", "worst"):
        view.add_column(name, justify="right", no_wrap=True)
    for place, cell in enumerate(cells):
        frame, plan = cell.frame_ms, cell.plan_ms
        texts = (f"{frame.count}", f"{frame.p99:.1f}", f"{frame.worst:.1f}", f"{cell.late_frames}")
        more = (f"{plan.count}", f"{plan.median:.1f}", f"{plan.p99:.1f}", f"{plan.worst:.1f}")
        view.add_row(scene_label(cell.scene), str(cell.queue_size), *texts, *more, end_section=_is_last(place, cells))
    return view


def _is_last(place: int, cells: Sequence[Cell]) -> bool:
    """Whether the next row is of another scene."""
    return place + 1 == len(cells) or cells[place + 1].scene != cells[place].scene


def _canned(cells: Sequence[CannedCell]) -> Table:
    view = _table("the same walks without planning of waist and arms")
    view.add_column("scene")
    for name in ("walks", "that touch", "touching frames", "deepest cm"):
        view.add_column(name, justify="right")
    for cell in cells:
        share = f"{cell.touching_frames} of {cell.frames} ({cell.share:.0%})"
        deepest = f"{100.0 * cell.deepest:.1f}"
        view.add_row(scene_label(cell.scene), str(cell.trials), str(cell.touching_trials), share, deepest)
    return view


def _table(title: str) -> Table:
    return Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))


def _bounded(estimate: Estimate | None, form: str) -> str:
    if estimate is None:
        return "-"
    if not math.isfinite(estimate.high):
        return format(estimate.value, form)
    return f"{estimate.value:{form}} ({estimate.low:{form}}–{estimate.high:{form}})"
