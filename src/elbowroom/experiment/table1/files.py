"""The table as CSV and as JSON."""

import csv
import io
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from elbowroom.experiment.paper_table import COLUMNS as PAPER_COLUMNS
from elbowroom.experiment.paper_table import TRIALS
from elbowroom.experiment.table1.cells import Averages, Cell, Estimate, scene_label
from elbowroom.experiment.table1.table import Table1

TIME_COLUMNS = ("frame_ms_worst", "frame_ms_p99", "plan_ms_worst", "plan_ms_p99")
OWN_COLUMNS = ("planner", "trials", "punctual", "late_frames", "least_clearance_mm")
RATES = ("pass_rate", "straight_rate")
MEANS = (
    *("stuck_times", "time_s", "plans_total", "plan_success_rate"),
    *("collision_checks", "checks_per_plan", "local_checks_per_plan"),
)


def columns() -> tuple[str, ...]:
    """The CSV's columns: the paper's, the times, ours; then all intervals, and the averages over all trials."""
    rates = [f"{name}_{end}" for name in RATES for end in ("low", "high")]
    means = [f"{name}_{kind}" for kind in ("passed", "all") for name in MEANS]
    bounded = [f"{name}{end}" for name in means for end in ("", "_low", "_high")]
    return (*PAPER_COLUMNS, *TIME_COLUMNS, *OWN_COLUMNS, *rates, *bounded)


def table_csv(table: Table1) -> str:
    """The table as CSV text, one row a cell. Averages in the paper's columns are over crossings that succeeded."""
    out = io.StringIO()
    writer = csv.DictWriter(out, columns(), lineterminator="\n")
    writer.writeheader()
    for cell in table.cells:
        writer.writerow(_csv_row(cell))
    return out.getvalue()


def _csv_row(cell: Cell) -> dict[str, str]:
    passed = cell.passed
    row: dict[str, Any] = {
        "scene": scene_label(cell.scene),
        "queue_size": cell.queue_size,
        "pass_rate": cell.pass_rate.value,
        "straight_rate": cell.straight_rate.value,
        "stuck_times": _value(passed.stuck_times),
        "passed_time_s": _value(passed.time_s),
        "plans_total": _value(passed.plans_total),
        "plan_success_rate": _value(passed.plan_success_rate),
        "plan_failed_rate": passed.plan_failed_rate,
        "collision_checks": _value(passed.collision_checks),
        "realtime": cell.realtime,
        "frame_ms_worst": cell.frame_ms.worst,
        "frame_ms_p99": cell.frame_ms.p99,
        "plan_ms_worst": cell.plan_ms.worst,
        "plan_ms_p99": cell.plan_ms.p99,
        "planner": cell.planner,
        "trials": cell.trials,
        "punctual": cell.punctual,
        "late_frames": cell.late_frames,
        "least_clearance_mm": 1e3 * cell.least_clearance,
    }
    for name in RATES:
        row |= _ends(name, getattr(cell, name))
    for kind, averages in (("passed", cell.passed), ("all", cell.all)):
        for name in MEANS:
            estimate: Estimate | None = getattr(averages, name)
            row |= {f"{name}_{kind}": _value(estimate)} | _ends(f"{name}_{kind}", estimate)
    return {name: _text(value) for name, value in row.items()}


def _ends(name: str, estimate: Estimate | None) -> dict[str, float | None]:
    low, high = (None, None) if estimate is None else (estimate.low, estimate.high)
    return {f"{name}_low": low, f"{name}_high": high}


def _value(estimate: Estimate | None) -> float | None:
    return None if estimate is None else estimate.value


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "Y" if value else "N"
    if isinstance(value, float):
        return f"{value:.6g}" if math.isfinite(value) else ""
    return "" if value is None else str(value)


def table_document(table: Table1, about: Mapping[str, Any]) -> dict[str, Any]:
    """The table as one plain JSON object; `about` tells what was asked, when, and on which kind of machine."""
    return {
        "format": "elbowroom-table1",
        "version": 1,
        **about,
        "paper": {
            "source": "Hsu & Li (2006), Table 1",
            "trials_a_cell": TRIALS,
        },
        "cells": [_cell_document(table, cell) for cell in table.cells],
        "canned_walk": [asdict(cell) | {"share": cell.share} for cell in table.canned],
        "touching_trials": sum(trial["least_clearance"] < 0.0 for trial in table.trials),
    }


def trials_document(table: Table1) -> dict[str, Any]:
    """Every trial with its seed; the cost of each single frame stays in the log of trials."""
    trials = [{name: value for name, value in trial.items() if name != "frame_ms"} for trial in table.trials]
    return {"trials": trials, "canned_trials": list(table.canned_trials)}


def _cell_document(table: Table1, cell: Cell) -> dict[str, Any]:
    paper = table.paper(cell)
    own = asdict(cell) | {"realtime": cell.realtime, "punctual": cell.punctual}
    for name, averages in (("passed", cell.passed), ("all", cell.all)):
        own[name]["plan_failed_rate"] = _failed(averages)
    beside = None if paper is None else asdict(paper) | {"checks_per_plan": paper.checks_per_plan}
    return own | {"paper": beside}


def _failed(averages: Averages) -> float | None:
    return averages.plan_failed_rate
