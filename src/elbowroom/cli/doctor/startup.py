"""How long a start takes, in fresh processes: to the first plan of a program, and to the first plan on the page."""

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from typing import Any

from elbowroom.cli.doctor.session_cost import started_server, wait_for_plan
from elbowroom.errors import InputError

WARM_BUDGET = 2.0  # seconds to the first plan, once the kernels are compiled
COLD_BUDGET = 90.0  # seconds, the first run of all

_PROGRAM = """
import elbowroom
controller = elbowroom.Controller(elbowroom.Humanoid.default(), elbowroom.Scene.load({scene!r}))
assert controller.step(elbowroom.Command(forward=1.0), 1 / 60).plan is not None
"""


@dataclass(frozen=True)
class Startup:
    """Seconds from the start of a process; the best of some runs, because a busy machine only ever adds."""

    program_seconds: float  # a program of three lines has its first plan
    program_cpu_seconds: float  # processor time of that
    page_seconds: float  # `elbowroom play` has shown a client its first plan
    warm_budget_seconds: float
    first_run_seconds: float | None  # the same with no kernel compiled; None: not measured
    first_run_budget_seconds: float


def measure_startup(scene: str, runs: int, *, first_run: bool) -> Startup:
    """Start programs and servers; with `first_run` also one that has to compile every kernel."""
    programs = [_program(scene) for _ in range(runs + 1)][1:]  # the first one reads the files from the disk
    return Startup(
        program_seconds=min(wall for wall, _ in programs),
        program_cpu_seconds=min(cpu for _, cpu in programs),
        page_seconds=min(_page(scene, dict(os.environ)) for _ in range(runs)),
        warm_budget_seconds=WARM_BUDGET,
        first_run_seconds=_first_run(scene) if first_run else None,
        first_run_budget_seconds=COLD_BUDGET,
    )


def _program(scene: str) -> tuple[float, float]:
    """Wall and processor seconds of a small program."""
    began, before = time.perf_counter(), os.times()
    done: subprocess.CompletedProcess[Any] = subprocess.run(
        [sys.executable, "-c", _PROGRAM.format(scene=scene)], capture_output=True, text=True, check=False
    )
    wall, after = time.perf_counter() - began, os.times()
    if done.returncode:
        raise InputError(f"doctor: a program did not run: {done.stderr.strip().splitlines()[-1:]}")
    return wall, after.children_user + after.children_system - before.children_user - before.children_system


def _page(scene: str, environment: dict[str, str]) -> float:
    began = time.perf_counter()
    with started_server(scene, environment) as url:
        wait_for_plan(url)
        return time.perf_counter() - began


def _first_run(scene: str) -> float:
    with tempfile.TemporaryDirectory(prefix="elbowroom-kernels-") as folder:
        return _page(scene, os.environ | {"NUMBA_CACHE_DIR": folder})
