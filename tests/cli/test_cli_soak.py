"""`elbowroom doctor --soak`: what it makes of its readings. The soak itself is for a quiet machine."""

import numpy as np
import pytest

from elbowroom.cli.doctor import doctor
from elbowroom.cli.doctor.soak import Soak, slope_of

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
    slope: float, minutes: float = 120.0, failures: dict[str, int] | None = None, on_time: float = 99.5
) -> dict[str, object]:
    return vars(
        Soak(
            minutes=minutes, sessions=900, courses=90, uploads=80, misdeeds=400, failures=failures or {},
            own_first=160.0, own_last=161.0, own_most=240.0, slope=slope, slope_budget=10.0, long_enough=minutes > 15.0,
            on_time_percent=on_time, on_time_budget_percent=99.0, late_budget_ms=25.0,
            late_ms_p99=31.0, late_ms_typical=12.0, frames_per_second=60.0,
        )
    )  # fmt: skip


def test_growth_beyond_the_budget_is_a_fault() -> None:
    assert doctor._soak_faults(soaked(9.0)) == []
    assert "memory grows" in doctor._soak_faults(soaked(11.0))[0]
    assert doctor._soak_faults(soaked(500.0, minutes=1.0)) == []  # too short to tell
    assert "HTTPError" in doctor._soak_faults(soaked(0.0, failures={"HTTPError": 2}))[0]
    assert doctor._soak_faults(None) == []


def test_late_frames_of_others_are_a_fault() -> None:
    assert "over 25 ms late" in doctor._soak_faults(soaked(0.0, on_time=98.7))[0]


def test_it_is_told_in_four_lines() -> None:
    text = "\n".join(line for _, line in doctor._soak_rows(soaked(3.0)))
    assert "900 sessions, 90 courses, 80 uploads, 400 misdeeds" in text
    assert "+3.0 MB an hour (budget 10)" in text
    assert "99.50 % of all frames at most 25 ms late (budget 99 %)" in text
    assert "99 % within 12 ms of their time, 31 ms in the worst 10 s" in text
    assert "too short" not in text
    assert "too short" in doctor._soak_rows(soaked(3.0, minutes=2.0))[1][1]
