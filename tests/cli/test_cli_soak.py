"""`elbowroom doctor --soak`: what it makes of its readings. The soak itself is for a quiet machine."""

import numpy as np
import pytest

from elbowroom.cli.doctor.soak import Soak, _Reading, _Yard, slope_of, summary
from elbowroom.cli.doctor.soak_text import soak_faults, soak_rows, telling

HOURS = np.linspace(0.0, 2.0, 300)


def test_a_flat_line_with_peaks_is_flat() -> None:
    rng = np.random.default_rng(0)
    own = 160.0 + rng.uniform(-3.0, 3.0, 300)
    own[rng.integers(300, size=30)] += 80.0  # an upload in the making
    assert abs(slope_of(HOURS, own)) < 2.0


def test_what_grows_is_seen() -> None:
    rng = np.random.default_rng(1)
    own = 160.0 + 25.0 * HOURS + rng.uniform(-3.0, 3.0, 300)
    assert slope_of(HOURS, own) == pytest.approx(25.0, abs=2.0)
    assert slope_of(HOURS[:1], own[:1]) == 0.0


def soaked(
    slope: float,
    minutes: float = 120.0,
    failures: dict[str, int] | None = None,
    on_time: float = 99.5,
    ran: float | None = None,
) -> dict[str, object]:
    return vars(
        Soak(
            minutes=minutes, ran=minutes if ran is None else ran,
            sessions=900, courses=90, uploads=80, misdeeds=400, failures=failures or {},
            own_first=160.0, own_last=161.0, own_most=240.0, kernels_first=300, kernels_last=310,
            slope=slope, slope_budget=10.0, long_enough=minutes > 15.0,
            on_time_percent=on_time, on_time_budget_percent=99.0, late_budget_ms=25.0,
            late_ms_p99=31.0, late_ms_typical=12.0, frames_per_second=60.0,
            cpu_percent=40.0, clients_cpu_percent=6.0,
        )
    )  # fmt: skip


def test_growth_beyond_the_budget_is_a_fault() -> None:
    assert soak_faults(soaked(9.0)) == []
    assert "memory grows" in soak_faults(soaked(11.0))[0]
    assert soak_faults(soaked(500.0, minutes=1.0)) == []  # too short to tell
    assert "HTTPError" in soak_faults(soaked(0.0, failures={"HTTPError": 2}))[0]
    assert soak_faults(None) == []


def test_late_frames_of_others_are_a_fault() -> None:
    assert "over 25 ms late" in soak_faults(soaked(0.0, on_time=98.7))[0]


def test_one_that_was_cut_short_says_so_and_tells_what_was_seen() -> None:
    cut = soaked(3.0, ran=34.0)
    assert "34.0 of 120" in soak_faults(cut)[0]
    assert "34 minutes of 120, then it was cut short: 900 sessions" in soak_rows(cut)[0][1]


@pytest.mark.parametrize("end", [KeyboardInterrupt, SystemExit])
def test_an_interrupt_ends_the_clients_time_and_what_was_read_is_summed_up(end: type[BaseException]) -> None:
    def cut() -> None:
        raise end

    yard = _Yard("", 1e12)
    with yard.ended_early():
        cut()
    assert yard.over()
    yard.failed(OSError("the server has gone"))  # with the same interrupt: no fault of the server's
    readings = [_Reading(60.0 * minute, 160.0, 3600.0 * minute, 0.0, 24.0 * minute, 300) for minute in range(21)]
    told = summary(yard, readings, 120.0, (1200.0, 60.0))
    assert (told.ran, told.failures, told.long_enough) == (20.0, {}, True)
    assert told.cpu_percent == pytest.approx(40.0)
    assert told.clients_cpu_percent == pytest.approx(5.0)


def test_where_nobody_sees_a_status_a_line_a_minute_is_written(capsys: pytest.CaptureFixture[str]) -> None:
    with telling(2.0) as tell:
        tell("0.0 min, 160 MB")
        tell("0.1 min, 160 MB")
    assert capsys.readouterr().err == "0.0 min, 160 MB\n"


def test_it_is_told_in_five_lines() -> None:
    text = "\n".join(line for _, line in soak_rows(soaked(3.0)))
    assert "900 sessions, 90 courses, 80 uploads, 400 misdeeds" in text
    assert "+3.0 MB an hour (budget 10)" in text
    assert "99.50 % of all frames at most 25 ms late (budget 99 %)" in text
    assert "99 % within 12 ms of their time, 31 ms in the worst 10 s" in text
    assert "the server took 40 % of one core, its clients 6 %" in text
    assert "too short" not in text
    assert "too short" in soak_rows(soaked(3.0, minutes=2.0))[1][1]
