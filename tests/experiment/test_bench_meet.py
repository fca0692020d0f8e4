"""`elbowroom bench meet`: which meetings there are, and what is made of them."""

from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from elbowroom.errors import InputError
from elbowroom.experiment.meeting.meeting import STEP, Met, Start, drawn
from elbowroom.experiment.meeting.meetings import MeetingTask, as_dict, meeting_tasks, run_meetings
from elbowroom.experiment.meeting.settings import MeetingKind, MeetingSettings


class Told:
    """Workers who only say how meetings end: those that begin with `failing` fail."""

    at_once = 1

    def __init__(self, failing: dict[Start, Met]) -> None:
        self._failing = failing

    def run(self, tasks: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        for place, task in reversed(list(enumerate(tasks))):
            yield place, self._failing.get(task.start, Met(task.start, True, False, 4.0, 0.0, 20.0, 0))


def test_a_seed_draws_the_same_start_within_the_corridor() -> None:
    for seed in range(50):
        start = drawn(0.95, MeetingKind.WALKS, seed)
        assert start == drawn(0.95, MeetingKind.WALKS, seed)
        assert all(abs(left) < 0.475 - 0.3 for left in start.left)
        assert min(start.paces) >= 0.6
        assert drawn(0.95, MeetingKind.STANDS, seed).paces[1] == 0.0
    assert len({drawn(0.95, MeetingKind.WALKS, seed) for seed in range(50)}) == 50


def test_corridors_are_told_one_by_one_with_the_starts_that_failed() -> None:
    settings = MeetingSettings((0.95, 1.2), 3)
    starts = [task.start for task in meeting_tasks(settings)]
    stuck = Met(starts[1], False, False, 15.0, 0.0, 40.0, 2)
    driven = Met(starts[4], True, False, 6.0, STEP + 0.1, 20.0, 0)
    touched = Met(starts[5], True, True, 6.0, 0.0, 20.0, 0)
    heard: list[int] = []
    results = run_meetings(settings, Told({one.start: one for one in (stuck, driven, touched)}), heard.append)
    assert heard == list(range(1, 13))
    assert [(row.kind, row.width, row.starts) for row in results] == [
        ("both walk", 0.95, 3), ("both walk", 1.2, 3), ("one stands", 0.95, 3), ("one stands", 1.2, 3)
    ]  # fmt: skip
    first, second, *others = results
    assert (first.passed, first.failed, first.frame_ms, first.late) == (2, (starts[1],), 40.0, 2)
    assert (second.passed, second.driven_back, second.touched, second.failed) == (3, 1, 1, (starts[4], starts[5]))
    assert all(row.well for row in others)
    assert not as_dict(results)["well"]


@pytest.mark.long
def test_a_meeting_of_its_own_process_is_the_same() -> None:
    start = drawn(1.6, MeetingKind.STANDS, 3)._replace(apart=1.5)
    met = MeetingTask(MeetingKind.STANDS, start).run()
    assert met.well
    again = MeetingTask(MeetingKind.STANDS, start).run()
    assert met._replace(frame_ms=0.0, late=0) == again._replace(frame_ms=0.0, late=0)


@pytest.mark.long
def test_two_whose_plans_come_late_meet_as_well() -> None:
    start = drawn(1.6, MeetingKind.STANDS, 3)._replace(apart=1.5)
    assert MeetingTask(MeetingKind.STANDS, start, live=True).run().well


@pytest.mark.parametrize(
    "wrong", [{"widths": ()}, {"widths": (0.5,)}, {"widths": (float("nan"),)}, {"starts": 0}, {"seed": -1}]
)
def test_what_cannot_be_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        MeetingSettings(**wrong)
