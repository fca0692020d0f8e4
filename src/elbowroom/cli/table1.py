"""`elbowroom table1`: the paper's experiment."""

from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_folder
from elbowroom.cli.options.lists import names_in, whole_numbers_in
from elbowroom.cli.options.workers import Cluster, Jobs, check_workers, chosen_workers
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import json_text, print_json, progress_bar, write_text
from elbowroom.cli.telling.time_left import time_left_bar
from elbowroom.experiment.table1.settings import Table1Settings
from elbowroom.planning.names import FIGURE6

if TYPE_CHECKING:
    from elbowroom.experiment.parallel import Workers
    from elbowroom.experiment.table1.table import Table1
EXAMPLES = "Examples:  elbowroom table1 --scene a,d --queue 3,5 --seeds 3  |  elbowroom table1 --seeds 20 --out results"
FELL_SHORT = 1
CSV, JSON, REPORT = "table1.csv", "table1.json", "report.html"


def table1(
    *,
    planner: Annotated[
        list[str] | None,
        typer.Option(
            "--planner", "--planners", metavar="NAME,...", help="Planners to compare: exact, figure6 (figure6)."
        ),
    ] = None,
    scene: Annotated[
        list[str] | None,
        typer.Option("--scene", "--scenes", metavar="NAME,...", help="Stock scenes by name, or scene files (a,b,c,d)."),
    ] = None,
    queue: Annotated[
        list[str] | None,
        typer.Option(
            "--queue", "--queues", metavar="N,...", help="Sizes of the key-frame queue, |Q|: each 2 to 32 (3,4,5,6,7)."
        ),
    ] = None,
    seeds: Annotated[int, typer.Option(help="Trials for each cell, with the seeds 1 to N; the paper has 3.")] = 20,
    jobs: Jobs = None,
    cluster: Cluster = None,
    out: Annotated[Path, typer.Option(help="Folder for results; an interrupted run goes on there.")] = Path("table1"),
    limit: Annotated[float, typer.Option(help="Seconds that the user has for each crossing.")] = 30.0,
    avatar: Annotated[Path | None, typer.Option(help="A VRM or GLB humanoid instead of the stock avatar.")] = None,
    live: Annotated[
        bool, typer.Option("--live", help="Plan beside playback, as a session does; trials do not repeat exactly.")
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Run the paper's crossing test for every scene, queue size and planner, and set it beside the paper's Table 1.

    Writes table1.csv, table1.json and report.html. Every finished trial is kept at once: the same call again goes on
    where an interrupted one was, and more seeds add to what is there. Exit code 0: done, 1: a shown pose touched an
    obstacle (a crossing that fails is a result like any other).
    """
    settings = _settings(planner, scene, queue, seeds, limit, avatar, live=live)
    check_folder(out)
    check_workers(cluster, jobs)
    from elbowroom.experiment.table1.files import table_csv, table_document, trials_document
    from elbowroom.experiment.table1.table import check

    check(settings)
    compile_first(quiet=quiet)

    with chosen_workers(cluster, jobs) as workers:
        with progress_bar("Opening the avatar", None, quiet):
            about = _about(settings, workers.at_once)
        table, page = _run(settings, about, out, workers, quiet=quiet)
    document = table_document(table, about)
    texts = page, table_csv(table), json_text(document | trials_document(table)) + "\n"
    files = _written(out, texts)
    if json:
        print_json(document | {"files": files})
    else:
        from elbowroom.cli.telling.table1_text import print_table1

        print_table1(table, about, files)
    raise typer.Exit(FELL_SHORT if document["touching_trials"] else 0)


def _written(out: Path, texts: tuple[str, str, str]) -> list[str]:
    """Write report, figures and trials into a folder; the files."""
    files = [out / name for name in (REPORT, CSV, JSON)]
    for path, text in zip(files, texts, strict=True):
        write_text(path, text)
    return [str(path) for path in files]


def _run(
    settings: Table1Settings, about: dict[str, Any], out: Path, workers: "Workers", *, quiet: bool
) -> "tuple[Table1, str]":
    """The table, and its report."""
    from elbowroom.experiment.report.crossings import successful_crossings
    from elbowroom.experiment.report.page import report_html
    from elbowroom.experiment.table1.table import run_table1

    try:
        with time_left_bar("Trials", quiet) as move:
            table = run_table1(settings, out, workers, move)
    except KeyboardInterrupt:
        typer.echo(f"elbowroom: interrupted; what is done is kept in {out}, the same call goes on from there", err=True)
        raise
    with progress_bar("Drawing the report", None, quiet):
        return table, report_html(table, about, successful_crossings(table, workers))


def _settings(
    planner: list[str] | None,
    scene: list[str] | None,
    queue: list[str] | None,
    seeds: int,
    limit: float,
    avatar: Path | None,
    *,
    live: bool,
) -> Table1Settings:
    planners = (FIGURE6,) if planner is None else names_in(planner)
    scenes = Table1Settings.scenes if scene is None else names_in(scene)
    queues = Table1Settings.queues if queue is None else whole_numbers_in("--queue", queue, "3,5")
    check_arguments(scenes=scenes, planners=planners, queues=queues, files=[avatar])
    return Table1Settings(planners, scenes, queues, seeds, limit, avatar, live)


def _about(settings: Table1Settings, processes: int) -> dict[str, Any]:
    """What was asked, when, and on what kind of machine."""
    from elbowroom.experiment.table1.table import identity, planner_settings, warm_kernels

    warm_kernels(settings)
    return {
        "command": _command(settings, processes),
        "date": datetime.now().astimezone().date().isoformat(),
        "machine": identity(settings)["machine"]["kind"],
        "settings": {
            "planners": list(settings.planners),
            "scenes": list(settings.scenes),
            "queues": list(settings.queues),
            "seeds": list(range(1, settings.seeds + 1)),
            "limit": settings.limit,
            "live": settings.live,
            "jobs": processes,
        },
        "identity": identity(settings),
        "planner_settings": planner_settings(settings),
    }


def _command(settings: Table1Settings, processes: int) -> str:
    words = {
        "planner": ",".join(settings.planners),
        "scene": ",".join(settings.scenes),
        "queue": ",".join(map(str, settings.queues)),
        "seeds": str(settings.seeds),
        "jobs": str(processes),
    }
    if settings.limit != type(settings).limit:
        words["limit"] = f"{settings.limit:g}"
    if settings.avatar is not None:
        words["avatar"] = settings.avatar.name
    text = "elbowroom table1 " + " ".join(f"--{name} {value}" for name, value in words.items())
    return text + " --live" if settings.live else text
