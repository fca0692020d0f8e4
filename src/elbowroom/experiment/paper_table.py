"""The paper's own Table 1, for comparison.

Hsu & Li, *Intelligent control of third-person avatars in virtual environments* (2006), Table 1: three trials a cell,
averages over the crossings that succeeded.
"""

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

COLUMNS = (
    "scene",
    "queue_size",
    "pass_rate",
    "straight_rate",
    "stuck_times",
    "passed_time_s",
    "plans_total",
    "plan_success_rate",
    "plan_failed_rate",
    "collision_checks",
    "realtime",
)
TRIALS = 3  # random seeds for each cell in the paper


@dataclass(frozen=True)
class PaperCell:
    """One row of the paper's table; None where it prints nothing, because no crossing succeeded."""

    scene: str  # "A" to "D"
    queue_size: int
    pass_rate: float
    straight_rate: float | None
    stuck_times: float | None
    passed_time_s: float | None
    plans_total: float | None
    plan_success_rate: float | None
    plan_failed_rate: float | None
    collision_checks: float | None
    realtime: bool | None

    @property
    def checks_per_plan(self) -> float | None:
        """Collision checks for each local planning call."""
        if self.collision_checks is None or not self.plans_total:
            return None
        return self.collision_checks / self.plans_total


@cache
def paper_table() -> dict[tuple[str, int], PaperCell]:
    """The cells by scene ("a" to "d", as the stock scenes are named) and queue size."""
    text = (files("elbowroom.experiment") / "data" / "paper_table1.csv").read_text("utf-8")
    cells = [_cell(row) for row in csv.DictReader(text.splitlines())]
    return {(cell.scene.lower(), cell.queue_size): cell for cell in cells}


def _cell(row: dict[str, str]) -> PaperCell:
    def number(column: str) -> float | None:
        return float(row[column]) if row[column] else None

    return PaperCell(
        scene=row["scene"],
        queue_size=int(row["queue_size"]),
        pass_rate=float(row["pass_rate"]),
        straight_rate=number("straight_rate"),
        stuck_times=number("stuck_times"),
        passed_time_s=number("passed_time_s"),
        plans_total=number("plans_total"),
        plan_success_rate=number("plan_success_rate"),
        plan_failed_rate=number("plan_failed_rate"),
        collision_checks=number("collision_checks"),
        realtime=row["realtime"] == "Y" if row["realtime"] else None,
    )
