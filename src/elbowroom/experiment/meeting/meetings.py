"""Many meetings of two avatars, and what came of them for each width of the corridor."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from statistics import median
from typing import Any

from elbowroom.errors import InputError
from elbowroom.experiment.meeting.meeting import Kind, Met, Start, drawn, load_kernels, meet
from elbowroom.experiment.opened import Thing
from elbowroom.experiment.parallel import Processes, Workers

WIDTHS = (0.95, 0.97, 1.0, 1.1, 1.2, 1.35, 1.45, 1.55, 1.6)  # metres
_NARROWEST, _WIDEST, _MOST = 0.8, 10.0, 10_000


@dataclass(frozen=True)
class MeetingSettings:
    """Which meetings there are. Meeting k has the seed `seed + k`."""

    widths: tuple[float, ...] = WIDTHS  # metres, of the corridors
    starts: int = 20  # in each, of each kind
    seed: int = 0
    kinds: tuple[Kind, ...] = tuple(Kind)

    def __post_init__(self) -> None:
        for width in self.widths:
            if not _NARROWEST <= width <= _WIDEST:
                raise InputError(f"width {width:g}: allowed are {_NARROWEST:g} to {_WIDEST:g} metres")
        if not self.widths:
            raise InputError("widths: at least one is needed")
        if not 1 <= self.starts <= _MOST:
            raise InputError(f"starts: {self.starts} is not a whole number from 1 to {_MOST}")
        if not 0 <= self.seed < 2**32:
            raise InputError(f"seed: {self.seed} is not a whole number from 0 to {2**32 - 1}")

    def tasks(self) -> list["MeetingTask"]:
        """A task for every meeting."""
        return [
            MeetingTask(kind, drawn(width, kind, self.seed + number))
            for kind in self.kinds
            for width in self.widths
            for number in range(self.starts)
        ]


@dataclass(frozen=True)
class MeetingTask:
    """A meeting that another process can hold."""

    kind: Kind
    start: Start

    @property
    def things(self) -> tuple[Thing[Any], ...]:
        """Nothing that would have to travel."""
        return ()

    def run(self) -> Met:
        """How it ends."""
        load_kernels()
        return meet(self.start)


@dataclass(frozen=True)
class WidthResult:
    """What came of all meetings of a kind in corridors of a width."""

    kind: str
    width: float  # metres
    starts: int
    passed: int
    touched: int  # meetings in which a frame touched
    driven_back: int  # meetings in which somebody was, by more than `STEP`
    back: float  # metres, the farthest
    seconds: float  # until they had passed, in half of the meetings
    frame_ms: float  # processor time of the longest step of one avatar, its plan included
    failed: tuple[Start, ...]

    @property
    def well(self) -> bool:
        """Whether every one went well."""
        return not self.failed


def run_meetings(
    settings: MeetingSettings,
    workers: Workers = Processes(),  # noqa: B008  frozen
    progress: Callable[[int], None] = lambda _: None,
) -> list[WidthResult]:
    """Let all meet; `progress` hears how many have met. Raises `InputError` where workers are lost."""
    tasks = settings.tasks()
    met: dict[int, Met] = {}
    for place, result in workers.run(tasks):
        met[place] = result
        progress(len(met))
    rows = range(0, len(tasks), settings.starts)
    return [
        _result(tasks[first].kind, [met[place] for place in range(first, first + settings.starts)]) for first in rows
    ]


def as_dict(results: list[WidthResult]) -> dict[str, Any]:
    """All figures, and whether every meeting went well."""
    return {"well": all(result.well for result in results), "corridors": [asdict(result) for result in results]}


def _result(kind: Kind, met: list[Met]) -> WidthResult:
    return WidthResult(
        kind=kind.value,
        width=met[0].start.width,
        starts=len(met),
        passed=sum(one.passed for one in met),
        touched=sum(one.touched for one in met),
        driven_back=sum(one.driven_back for one in met),
        back=max(one.back for one in met),
        seconds=median(one.seconds for one in met),
        frame_ms=max(one.frame_ms for one in met),
        failed=tuple(one.start for one in met if not one.well),
    )
