"""Tasks in processes of their own."""

import os
from dataclasses import dataclass
from typing import Any

import pytest

from elbowroom.errors import InputError
from elbowroom.experiment.opened import Openable
from elbowroom.experiment.parallel import Processes


@dataclass(frozen=True)
class Square:
    number: int
    things: tuple[Openable[Any], ...] = ()

    def run(self) -> tuple[int, int]:
        if self.number < 0:
            raise InputError(f"{self.number} is negative")
        return self.number**2, os.getpid()


@dataclass(frozen=True)
class Death:
    things: tuple[Openable[Any], ...] = ()

    def run(self) -> None:
        os._exit(9)


def test_every_task_is_done_once_elsewhere() -> None:
    results = dict(Processes(2).run([Square(number) for number in range(12)]))
    assert {place: value for place, (value, _) in results.items()} == {n: n * n for n in range(12)}
    assert os.getpid() not in {pid for _, pid in results.values()}


def test_what_a_task_raises_is_raised() -> None:
    with pytest.raises(InputError, match="-3 is negative"):
        list(Processes(1).run([Square(-3)]))


def test_a_process_that_dies_is_a_plain_error() -> None:
    with pytest.raises(InputError, match="worker process died"):
        list(Processes(1).run([Death()]))


def test_nothing_to_do_starts_nothing() -> None:
    assert list(Processes(4).run([])) == []


@pytest.mark.parametrize("jobs", [0, -1, 100_000])
def test_impossible_numbers_of_processes_are_plain_errors(jobs: int) -> None:
    with pytest.raises(InputError, match="jobs"):
        Processes(jobs)
