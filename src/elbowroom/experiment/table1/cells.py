"""The table's cells, folded from trials."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.statistics import Interval, mean_interval, percentile, ratio_interval, wilson

Floats = NDArray[np.float64]
Record = dict[str, Any]


@dataclass(frozen=True)
class Estimate:
    """A number from a finite number of trials, with its 95 % interval (infinite ends: unknown)."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Averages:
    """Means over some trials of a cell; None where there is no trial to average."""

    trials: int
    stuck_times: Estimate | None
    time_s: Estimate | None  # seconds to cross; a crossing that failed counts with the whole limit
    plans_total: Estimate | None
    plan_success_rate: Estimate | None  # mean of the trials' rates
    collision_checks: Estimate | None
    checks_per_plan: Estimate | None  # all checks over all local planning calls, and
    local_checks_per_plan: Estimate | None  # those of local planning alone

    @property
    def plan_failed_rate(self) -> float | None:
        """The rate of local planning calls that found nothing."""
        return None if self.plan_success_rate is None else 1.0 - self.plan_success_rate.value


@dataclass(frozen=True)
class MillisecondsTaken:
    """Milliseconds that frames or planning calls took, over all trials of a cell."""

    count: int
    median: float
    p99: float
    worst: float


@dataclass(frozen=True)
class Cell:
    """One row of the table."""

    planner: str
    scene: str
    queue_size: int
    trials: int
    pass_rate: Estimate
    straight_rate: Estimate
    passed: Averages  # over the crossings that succeeded, as in the paper
    all: Averages  # over all trials
    realtime_trials: int  # trials that met the paper's criterion
    punctual_trials: int  # trials without a frame later than 1/60 s
    late_frames: int
    frame_ms: MillisecondsTaken
    plan_ms: MillisecondsTaken
    least_clearance: float  # metres, over all frames of all trials

    @property
    def realtime(self) -> bool:
        """The paper's criterion, met by every trial."""
        return self.realtime_trials == self.trials

    @property
    def punctual(self) -> bool:
        """Ours: no frame of any trial was shown later than 1/60 s after it was due."""
        return self.punctual_trials == self.trials


@dataclass(frozen=True)
class CannedCell:
    """The plain walk through a scene: no planning of the upper body."""

    scene: str
    trials: int
    touching_trials: int
    frames: int
    touching_frames: int
    deepest: float  # metres

    @property
    def share(self) -> float:
        """The part of all frames in which the body is inside an obstacle."""
        return self.touching_frames / max(1, self.frames)


def scene_label(name: str) -> str:
    """How tables call a scene: "a" is the paper's A, other names stay as they are."""
    return name.upper() if len(name) == 1 else name


def fold_cell(records: Sequence[Record], limit: float) -> Cell:
    """The cell of these trials (all of one planner, scene and queue size, at least one)."""
    first, trials = records[0], len(records)
    passed = [record for record in records if record["passed"]]
    return Cell(
        planner=first["planner"],
        scene=first["scene"],
        queue_size=first["queue_size"],
        trials=trials,
        pass_rate=_rate(len(passed), trials),
        straight_rate=_rate(sum(record["straight"] for record in records), trials),
        passed=_averages(passed, limit),
        all=_averages(records, limit),
        realtime_trials=sum(record["realtime"] for record in records),
        punctual_trials=sum(record["late_frames"] == 0 for record in records),
        late_frames=sum(record["late_frames"] for record in records),
        frame_ms=_taken([value for record in records for value in record["frame_ms"]]),
        plan_ms=_taken([value for record in records for value in record["plan_ms"]]),
        least_clearance=min(record["least_clearance"] for record in records),
    )


def fold_canned(records: Sequence[Record]) -> CannedCell:
    """The plain walk's row for the walks through one scene."""
    return CannedCell(
        scene=records[0]["scene"],
        trials=len(records),
        touching_trials=sum(record["touching_frames"] > 0 for record in records),
        frames=sum(record["frames"] for record in records),
        touching_frames=sum(record["touching_frames"] for record in records),
        deepest=max(record["deepest"] for record in records),
    )


def _rate(successes: int, trials: int) -> Estimate:
    return Estimate(successes / trials, *wilson(successes, trials))


def _averages(records: Sequence[Record], limit: float) -> Averages:
    def mean(value: Callable[[Record], float], highest: float = np.inf) -> Estimate | None:
        values = [float(value(record)) for record in records]
        if not values:
            return None
        low, high = mean_interval(values)
        return Estimate(float(np.mean(values)), max(0.0, low), min(highest, high))

    def seconds(record: Record) -> float:
        return limit if record["passed_time_s"] is None else float(record["passed_time_s"])

    return Averages(
        trials=len(records),
        stuck_times=mean(lambda record: record["stuck_times"]),
        time_s=mean(seconds, limit),
        plans_total=mean(lambda record: record["plans_total"]),
        plan_success_rate=mean(lambda record: record["plan_success_rate"], 1.0),
        collision_checks=mean(lambda record: record["collision_checks"]),
        checks_per_plan=_per_plan(records, "collision_checks"),
        local_checks_per_plan=_per_plan(records, "local_checks"),
    )


def _per_plan(records: Sequence[Record], name: str) -> Estimate | None:
    checks = [record[name] for record in records]
    plans = [record["plans_total"] for record in records]
    if not sum(plans):
        return None
    interval: Interval = ratio_interval(checks, plans, np.random.default_rng(0))
    return Estimate(sum(checks) / sum(plans), *interval)


def _taken(values: Sequence[float]) -> MillisecondsTaken:
    return MillisecondsTaken(
        len(values), percentile(values, 50.0), percentile(values, 99.0), max(values, default=float("nan"))
    )
