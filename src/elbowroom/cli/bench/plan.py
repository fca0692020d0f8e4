"""`elbowroom bench plan`: what a planning call costs, and how that grows."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_folder
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, print_row, progress_bar
from elbowroom.experiment.bench.settings import PlanSettings

if TYPE_CHECKING:
    from elbowroom.experiment.bench.plan import PlanCallsReport

EXAMPLES = "Examples:  elbowroom bench plan  |  elbowroom bench plan --scene c --key-frames 16 --plots pictures --json"


def plan(
    *,
    scene: Annotated[str, typer.Option(help="The scene that is crossed.")] = "d",
    key_frames: Annotated[int, typer.Option(help="Key frames ahead, 0.15 s apart.")] = 12,
    rounds: Annotated[int, typer.Option(help="How many crossings are walked.")] = 20,
    starts: Annotated[int, typer.Option(help="Further crossings, each from another start.")] = 20,
    plots: Annotated[Path | None, typer.Option(help="Folder for pictures of how the cost grows.")] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Time every planning call of `exact`, root and upper body together, while an avatar crosses a scene."""
    settings = PlanSettings(scene=scene, key_frames=key_frames, rounds=rounds, starts=starts)
    check_arguments(scenes=[scene])
    check_folder(plots)
    from elbowroom.experiment.bench.plan import amount, run
    from elbowroom.experiment.machine import machine_kind
    from elbowroom.world.scene import Scene

    Scene.load(settings.scene)  # which tells of a damaged one
    compile_first(quiet=quiet)
    if plots is not None:
        _make_folder(plots)
    with progress_bar("Planning", amount(settings), quiet) as bar:
        report = run(settings, bar.move)
    if json:
        print_json({"machine": machine_kind()} | report.as_dict())
    else:
        show(report)
    if plots is not None:
        _write_plots(report, plots)


def show(report: "PlanCallsReport") -> None:
    """The figures as tables."""
    from elbowroom.experiment.machine import machine_kind

    settings, calls = report.settings, report.calls
    rows = {
        "calls": f"{calls.calls}, of which {calls.searched} searched; the rest go on as planned",
        "median": f"{calls.median_ms:.3g} ms ({calls.median_clock_ms:.3g} by the clock)",
        "median of those that searched": f"{calls.search_median_ms:.3g} ms",
        "99 %": f"{calls.p99_ms:.3g} ms",
        "worst": f"{calls.worst_ms:.3g} ms ({calls.worst_clock_ms:.3g} by the clock)",
        "checks, median of those that searched": f"{calls.median_checks:.0f}",
        "checks, worst": f"{calls.worst_checks}, {calls.worst_to_median_checks:.1f} times the median",
        "found": f"{100.0 * calls.found:.1f} %",
    }
    print_row(f"Planning in scene {settings.scene}, {settings.key_frames} key frames ahead ({machine_kind()})", rows)
    other = report.elsewhere
    rows = {
        "median": f"{other.median_ms:.3g} ms",
        "99 %": f"{other.p99_ms:.3g} ms",
        "worst": f"{other.worst_ms:.3g} ms of {other.calls} calls",
    }
    print_row(f"From {settings.starts} other starts", rows)
    for name, places, costs in (
        ("By key frames ahead", settings.horizons, report.by_horizon),
        ("By posts at a lane", settings.obstacles, report.by_obstacles),
    ):
        texts = [
            f"{cost.median_ms:.3g} ms, {cost.search_median_ms:.3g} with a search (99 %: {cost.p99_ms:.3g})"
            for cost in costs
        ]
        print_row(name, dict(zip(map(str, places), texts, strict=True)))


def _make_folder(folder: Path) -> None:
    """Before anything is measured: a name that will not do is told at once."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable(folder, error) from None


def _write_plots(report: "PlanCallsReport", folder: Path) -> None:
    from elbowroom.experiment.bench.plots import growth_plots

    try:
        for name, picture in growth_plots(report).items():
            (folder / f"planning_by_{name}.svg").write_text(picture, "utf-8")
    except OSError as error:
        raise _unwritable(folder, error) from None


def _unwritable(folder: Path, error: OSError) -> Exception:
    from elbowroom.errors import InputError

    return InputError(f"{folder}: cannot write pictures there: {error.strerror}")
