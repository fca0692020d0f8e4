"""`elbowroom doctor --soak`: what it makes of its readings. The soak itself is for a quiet machine."""

import numpy as np
import pytest

from elbowroom.cli import doctor
from elbowroom.cli.soak import Soak, slope_of

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


def soaked(slope: float, minutes: float = 120.0, failures: dict[str, int] | None = None) -> dict[str, object]:
    long_enough = minutes > 15.0
    return vars(
        Soak(minutes, 900, 90, 80, 400, failures or {}, 160.0, 161.0, 240.0, slope, 10.0, long_enough, 12.0, 60.0)
    )


def test_growth_beyond_the_budget_is_a_fault() -> None:
    assert doctor._soak_faults(soaked(9.0)) == []
    assert "memory grows" in doctor._soak_faults(soaked(11.0))[0]
    assert doctor._soak_faults(soaked(500.0, minutes=1.0)) == []  # too short to tell
    assert "HTTPError" in doctor._soak_faults(soaked(0.0, failures={"HTTPError": 2}))[0]
    assert doctor._soak_faults(None) == []


def test_it_is_told_in_three_lines() -> None:
    text = "\n".join(line for _, line in doctor._soak_rows(soaked(3.0)))
    assert "900 sessions, 90 courses, 80 uploads, 400 misdeeds" in text
    assert "+3.0 MB an hour (budget 10)" in text
    assert "too short" not in text
    assert "too short" in doctor._soak_rows(soaked(3.0, minutes=2.0))[1][1]
