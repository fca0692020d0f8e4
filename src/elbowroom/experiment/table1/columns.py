"""The columns of the paper's Table 1, as both our cells and the paper's have them."""

from collections.abc import Callable
from typing import NamedTuple

from elbowroom.experiment.paper_table import PaperCell
from elbowroom.experiment.table1.cells import Cell, Estimate


class Column(NamedTuple):
    """One quantity: where it lies in a cell, and how it is written."""

    form: str
    ours: Callable[[Cell], Estimate | None]
    paper: Callable[[PaperCell], float | None]


COLUMNS = (
    Column(".2f", lambda cell: cell.pass_rate, lambda paper: paper.pass_rate),
    Column(".2f", lambda cell: cell.straight_rate, lambda paper: paper.straight_rate),
    Column(".1f", lambda cell: cell.passed.stuck_times, lambda paper: paper.stuck_times),
    Column(".1f", lambda cell: cell.passed.time_s, lambda paper: paper.passed_time_s),
    Column(".0f", lambda cell: cell.passed.plans_total, lambda paper: paper.plans_total),
    Column(".2f", lambda cell: cell.passed.plan_success_rate, lambda paper: paper.plan_success_rate),
    Column(".0f", lambda cell: cell.passed.checks_per_plan, lambda paper: paper.checks_per_plan),
)


def our_texts(cell: Cell, write: Callable[[float | None, str], str]) -> list[str]:
    """A cell's columns, each number by `write`, and last whether it kept real time."""
    estimates = [(column.ours(cell), column.form) for column in COLUMNS]
    return [*(write(None if one is None else one.value, form) for one, form in estimates), _yes_no(cell.realtime, "")]


def paper_texts(paper: PaperCell, write: Callable[[float | None, str], str]) -> list[str]:
    """The same of the paper; `write` also says what stands for a number that it does not give."""
    return [*(write(column.paper(paper), column.form) for column in COLUMNS), _yes_no(paper.realtime, write(None, ""))]


def _yes_no(value: bool | None, unknown: str) -> str:
    return unknown if value is None else "yes" if value else "no"
