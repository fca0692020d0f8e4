"""Tasks in processes of their own."""

import os
from dataclasses import dataclass

import pytest

from elbowroom.errors import InputError
from elbowroom.experiment.parallel import run_all


@dataclass(frozen=True)
class Square:
    number: int

    def run(self) -> tuple[int, int]:
        if self.number < 0:
            raise InputError(f"{self.number} is negative")
        return self.number**2, os.getpid()


@dataclass(frozen=True)
class Death:
    def run(self) -> None:
        os._exit(9)


def test_every_task_is_done_once_elsewhere() -> None:
    results = dict(run_all([Square(number) for number in range(12)], 2))
    assert {place: value for place, (value, _) in results.items()} == {n: n * n for n in range(12)}
    assert os.getpid() not in {pid for _, pid in results.values()}


def test_what_a_task_raises_is_raised() -> None:
    with pytest.raises(InputError, match="-3 is negative"):
        list(run_all([Square(-3)], 1))


def test_a_process_that_dies_is_a_plain_error() -> None:
    with pytest.raises(InputError, match="worker process died"):
        list(run_all([Death()], 1))


def test_nothing_to_do_starts_nothing() -> None:
    assert list(run_all([], 4)) == []


@pytest.mark.parametrize("jobs", [0, -1, 100_000])
def test_impossible_numbers_of_processes_are_plain_errors(jobs: int) -> None:
    with pytest.raises(InputError, match="jobs"):
        list(run_all([Square(1)], jobs))
