"""`elbowroom bench planners`: our planners and a general one on the same crossings."""

from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.lists import names_in, whole_numbers_in
from elbowroom.cli.options.workers import Cluster, check_workers, chosen_workers
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, progress_bar
from elbowroom.experiment.bench.settings import PlannersSettings

if TYPE_CHECKING:
    from elbowroom.experiment.bench.planners import PlannersReport

EXAMPLES = "Examples:  elbowroom bench planners  |  elbowroom bench planners --scene c,d --level 3 --trials 10 --json"

_WIDTH = 100  # characters: of the table
_LEGEND = """planning: all of a crossing's, median of the trials; longest: the longest wait for a plan; checks, median:
capsules held against boxes by exact, candidates tested by figure6, motions checked by RRT-Connect; touching: of the
judge's poses, 240 a second; away: from the natural walk, root mean square; swing: mean joint speed."""


def planners(
    *,
    scene: Annotated[
        list[str] | None, typer.Option("--scene", "--scenes", metavar="NAME,...", help="Scenes to cross (a,b,c,d).")
    ] = None,
    level: Annotated[
        list[str] | None, typer.Option("--level", "--levels", metavar="N,...", help="Gauntlet levels (1,2,3).")
    ] = None,
    trials: Annotated[int, typer.Option(help="Seeds in a scene, straight courses of a level.")] = 3,
    limit: Annotated[float, typer.Option(help="Seconds to cross, and for the general planner to plan.")] = 30.0,
    jobs: Annotated[int, typer.Option(help="Crossings at once; 1 gives the truest times.")] = 1,
    cluster: Cluster = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compare `figure6`, `exact` and OMPL's RRT-Connect on the same crossings, by the same judge.

    RRT-Connect plans the whole crossing before the first step, with the whole scene known and the root's walk given;
    ours plan as they go, obey the user, and are judged by what they showed.
    """
    chosen = PlannersSettings(trials=trials, limit=limit)
    if scene is not None or level is not None:
        levels = whole_numbers_in("--level", level or (), "1,3")
        chosen = PlannersSettings(names_in(scene or ()), levels, trials, limit)
    check_workers(cluster, jobs)
    check_arguments(scenes=() if scene is None else chosen.scenes)
    from elbowroom.experiment.bench.general import check_installed
    from elbowroom.experiment.bench.planners import amount, as_dict, run
    from elbowroom.experiment.gauntlet.scenes import load_scene
    from elbowroom.experiment.machine import machine_kind

    check_installed()
    for name in chosen.scenes:
        load_scene(name)  # which tells of a damaged one
    compile_first(quiet=quiet)
    with chosen_workers(cluster, jobs) as workers, progress_bar("Crossing", amount(chosen), quiet) as bar:
        report = run(chosen, bar.move, workers)
    if json:
        print_json({"machine": machine_kind()} | as_dict(report))
    else:
        _show(report)


def _show(report: "PlannersReport") -> None:
    import numpy as np
    from rich.console import Console
    from rich.table import Table

    from elbowroom.experiment.machine import machine_kind

    columns = "where", "planner", "through", "planning s", "longest ms", "checks", "touching", "away rad", "swing rad/s"
    table = Table(title=f"Crossings ({machine_kind()})", title_justify="left", box=None)
    for column in columns:
        table.add_column(column, justify="left" if column in columns[:2] else "right")
    for where, planner, runs in report.cells():
        done = [run for run in runs if np.isfinite(run.away)]
        table.add_row(
            where,
            planner,
            f"{sum(run.through for run in runs)}/{len(runs)}",
            f"{np.median([run.planning_seconds for run in runs]):.3g}",
            f"{max(run.longest_plan_ms for run in runs):.3g}",
            f"{np.median([run.checks for run in runs]):.0f}",
            str(sum(run.touching for run in runs)),
            f"{np.mean([run.away for run in done]):.3f}" if done else "-",
            f"{np.mean([run.swing for run in done]):.2f}" if done else "-",
        )
    console = Console()
    (console if console.width >= _WIDTH else Console(width=_WIDTH)).print(table)
    print(_LEGEND)
