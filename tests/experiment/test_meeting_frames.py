"""What a frame of two who meet costs: counted, not timed. It was up to two seconds; `bench meet --live` times it."""

from typing import Any

import numpy as np
import pytest

from elbowroom.control.frame import Frame
from elbowroom.control.plans.desk import Job
from elbowroom.experiment.meeting import meeting
from elbowroom.experiment.meeting.meeting import drawn, meet
from elbowroom.experiment.meeting.settings import MeetingKind
from late_desk import LateDesk
from noted_kernels import note_kernels
from sampled import sampled

CALLS, NUMBERS = 300, 350_000  # twice the most that there are; a plan takes 1000 and 3 million
LATE = 3  # turns after which plans are there


class Cost:
    """Of a frame, with what the other is told of it: calls of kernels, and numbers in the arrays given to them."""

    def __init__(self) -> None:
        self.calls = self.numbers = 0


class Counted:
    """The costs of all frames of a meeting; what is planned costs none."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.frames: list[Cost] = []
        self.planning = False
        step = meeting._Walker.step

        def counted(walker: meeting._Walker) -> Frame:
            self.frames.append(Cost())
            desk: Any = walker._desk
            desk.next_turn()
            return step(walker)

        monkeypatch.setattr(meeting._Walker, "step", counted)
        monkeypatch.setattr(meeting, "BesideDesk", lambda _: Apart(self))
        note_kernels(monkeypatch, self._note)

    def _note(self, _: Any, arguments: tuple[Any, ...]) -> None:
        if self.frames and not self.planning:
            self.frames[-1].calls += 1
            self.frames[-1].numbers += sum(one.size for one in arguments if isinstance(one, np.ndarray))


class Apart(LateDesk):
    """Plans are made elsewhere, as in a thread."""

    processor = 0.0

    def __init__(self, counted: Counted) -> None:
        super().__init__(LATE)
        self._counted = counted

    def submit(self, job: Job) -> None:
        self._counted.planning = True
        super().submit(job)
        self._counted.planning = False


@pytest.mark.parametrize(
    ("kind", "width", "seed", "seconds"),
    sampled(
        [
            (MeetingKind.WALKS, 1.2, 0, 0.8),
            (MeetingKind.STANDS, 0.97, 3, 0.8),
            *[(kind, width, seed, 15.0) for kind in MeetingKind for width in (0.95, 1.2, 1.6) for seed in (0, 1)],
        ],
        2,
    ),
)
def test_no_frame_is_dear_where_two_meet(
    kind: MeetingKind, width: float, seed: int, seconds: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While they come close to each other, or until they have passed."""
    counted, start = Counted(monkeypatch), drawn(width, kind, seed)
    whole = seconds > 2.0
    met = meet(start if whole else start._replace(apart=1.3), seconds, live=True)
    assert (met.passed or not whole, met.touched) == (True, False)
    assert len(counted.frames) == 2 * round(60 * met.seconds)
    assert min(frame.calls for frame in counted.frames) > 5
    assert max(frame.calls for frame in counted.frames) < CALLS
    assert max(frame.numbers for frame in counted.frames) < NUMBERS
