"""How `elbowroom doctor --soak` is told: while it goes on, in lines at its end, and what of it is a fault."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import typer
from rich.console import Console

_EVERY = 60.0  # seconds between two lines where nobody sees a status


@contextmanager
def telling(minutes: float) -> Iterator[Callable[[str], object]]:
    """What hears how a soak goes: a status on a terminal, else a line a minute on stderr, so that none is lost."""
    console = Console(stderr=True)
    if console.is_terminal:
        with console.status(f"Clients come and go for {minutes:g} minutes ...") as status:
            yield lambda how: status.update(f"Clients come and go: {how}")
        return
    told = -_EVERY

    def line(how: str) -> None:
        nonlocal told
        if time.monotonic() >= told + _EVERY:
            told = time.monotonic()
            typer.echo(how, err=True)

    yield line


def soak_faults(soaked: dict[str, Any] | None) -> list[str]:
    """What of a soak (the fields of `Soak`) exceeds its budget, in sentences; nothing of none."""
    if soaked is None:
        return []
    faults = [f"clients that behave were failed: {soaked['failures']}"] if soaked["failures"] else []
    if soaked["ran"] < soaked["minutes"]:
        faults.append(f"the soak was cut short after {soaked['ran']:.1f} of {soaked['minutes']:g} minutes")
    if soaked["long_enough"] and soaked["slope"] > soaked["slope_budget"]:
        faults.append("the server's memory grows faster than its budget")
    if soaked["on_time_percent"] < soaked["on_time_budget_percent"]:
        faults.append(
            f"more frames than 1 in 100 were over {soaked['late_budget_ms']:g} ms late while clients misbehaved"
        )
    return faults


def soak_rows(soaked: dict[str, Any] | None) -> list[tuple[str, str]]:
    """What came of a soak (the fields of `Soak`), in lines with their names."""
    if soaked is None:
        return []
    clients = f"{soaked['sessions']} sessions, {soaked['courses']} courses, {soaked['uploads']} uploads"
    own = f"own memory {soaked['own_first']:.0f} MB after the warm-up, {soaked['own_last']:.0f} in the end"
    loaded = f"{soaked['kernels_first']} kernels in memory after the warm-up, {soaked['kernels_last']} in the end"
    slope = f"{soaked['slope']:+.1f} MB an hour (budget {soaked['slope_budget']:g})"
    short = "" if soaked["long_enough"] else "; too short for a verdict: 15 minutes or more"
    frames = f"{soaked['frames_per_second']:.1f} frames/s, 99 % within {soaked['late_ms_typical']:.0f} ms of their time"
    share = f"{soaked['on_time_percent']:.2f} % of all frames at most {soaked['late_budget_ms']:g} ms late"
    cut = "" if soaked["ran"] >= soaked["minutes"] else f" of {soaked['minutes']:g}, then it was cut short"
    took = f"{soaked['cpu_percent']:.0f} % of one core, its clients {soaked['clients_cpu_percent']:.0f} %"
    return [
        ("soak", f"{min(soaked['ran'], soaked['minutes']):.3g} minutes{cut}: {clients}, {soaked['misdeeds']} misdeeds"),
        ("", f"{own}, {soaked['own_most']:.0f} at most: {slope}{short}"),
        ("", loaded),
        ("", f"{share} (budget {soaked['on_time_budget_percent']:g} %)"),
        ("", f"the server took {took}"),
        ("", f"one who walked on all the time: {frames}, {soaked['late_ms_p99']:.0f} ms in the worst 10 s"),
    ]
