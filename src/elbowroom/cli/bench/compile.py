"""`elbowroom bench compile`: what the first start waits for, every kernel compiled anew into an empty folder."""

import os
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.telling.output import print_json, print_row, progress_bar

EXAMPLES = "Examples:  elbowroom bench compile  |  elbowroom bench compile --json"


@dataclass(frozen=True)
class CompileCost:
    """What it took to compile all that a live session uses."""

    seconds: float  # by the clock
    cpu_seconds: float  # of all processes together; 0 where the system does not tell
    processes: int  # at once
    kernels: int
    compilations: int  # more than kernels, where one was compiled for several types of arguments
    repeated: tuple[str, ...]  # those kernels
    megabytes: float  # on disk
    complete: bool  # every process ended well


def compile_(
    *,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compile all kernels of a live session as the first start does; what is compiled already is left alone."""
    from dataclasses import asdict

    from elbowroom.experiment.machine import machine_kind

    cost = measure(quiet=quiet)
    if json:
        print_json({"machine": machine_kind()} | asdict(cost))
    else:
        show(cost)
    if not cost.complete:
        raise typer.Exit(1)


def measure(*, quiet: bool) -> CompileCost:
    """Compile into a folder of its own, with a progress bar unless `quiet`."""
    from elbowroom.server.kernels.compiling import compile_all, processes
    from elbowroom.server.kernels.kernel_cache import session_kernels

    with (
        tempfile.TemporaryDirectory(prefix="elbowroom-kernels-") as folder,
        progress_bar("Compiling", len(session_kernels()), quiet) as bar,
    ):
        began, before = time.perf_counter(), os.times()
        environment = os.environ | {"NUMBA_CACHE_DIR": folder}
        complete = compile_all(lambda kernel, number: bar.move(number, kernel), environment)
        seconds, after = time.perf_counter() - began, os.times()
        kept = compiled_in(Path(folder))
        return CompileCost(
            seconds=seconds,
            cpu_seconds=after.children_user + after.children_system - before.children_user - before.children_system,
            processes=processes(),
            kernels=len(kept),
            compilations=sum(kept.values()),
            repeated=tuple(sorted(kernel for kernel, count in kept.items() if count > 1)),
            megabytes=sum(file.stat().st_size for file in Path(folder).rglob("*") if file.is_file()) / 1e6,
            complete=complete,
        )


def compiled_in(folder: Path) -> dict[str, int]:
    """How often each kernel was compiled, by the files of a cache: FILE.FUNCTION-LINE.VERSION.NUMBER.nbc."""
    found: dict[str, int] = {}
    for file in folder.rglob("*.nbc"):
        kernel = file.name.partition("-")[0]
        found[kernel] = found.get(kernel, 0) + 1
    return found


def show(cost: CompileCost) -> None:
    """The figures as a table."""
    from elbowroom.experiment.machine import machine_kind

    rows = {
        "by the clock": f"{cost.seconds:.0f} s",
        "processor time": f"{cost.cpu_seconds:.0f} s in {cost.processes} processes at once",
        "kernels": f"{cost.kernels}, compiled {cost.compilations} times",
        "for several types": ", ".join(cost.repeated) or "none",
        "on disk": f"{cost.megabytes:.0f} MB",
    }
    if not cost.complete:
        rows["failed"] = "a process ended early; the rest is compiled where it is needed"
    print_row(f"Compiling every kernel of a live session ({machine_kind()})", rows)
