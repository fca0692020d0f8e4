"""Many meetings of two avatars, and what came of them for each width of the corridor."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from statistics import median
from typing import Any

from elbowroom.experiment.meeting.meeting import Met, Start, drawn, load_kernels, meet
from elbowroom.experiment.meeting.settings import MeetingKind, MeetingSettings
from elbowroom.experiment.opened import Openable
from elbowroom.experiment.parallel import Processes, Workers


@dataclass(frozen=True)
class MeetingTask:
    """A meeting that another process can hold."""

    kind: MeetingKind
    start: Start
    live: bool = False

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """Nothing that would have to travel."""
        return ()

    def run(self) -> Met:
        """How it ends."""
        load_kernels()
        return meet(self.start, live=self.live)


def meeting_tasks(settings: MeetingSettings) -> list[MeetingTask]:
    """A task for every meeting."""
    return [
        MeetingTask(kind, drawn(width, kind, settings.seed + number), settings.live)
        for kind in settings.kinds
        for width in settings.widths
        for number in range(settings.starts)
    ]


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
    frame_ms: float  # processor time of the longest step of one avatar; with its plan, where plans are made at once
    late: int  # frames shown later than a frame after they were due
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
    tasks = meeting_tasks(settings)
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


def _result(kind: MeetingKind, met: list[Met]) -> WidthResult:
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
        late=sum(one.late for one in met),
        failed=tuple(one.start for one in met if not one.well),
    )
