"""`elbowroom bench meet`: two avatars who meet in a corridor, and whether they get past each other."""

from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.lists import numbers_in
from elbowroom.cli.options.workers import Jobs, check_workers, chosen_workers
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, progress_bar
from elbowroom.experiment.meeting.settings import WIDTHS, MeetingSettings

if TYPE_CHECKING:
    from elbowroom.experiment.meeting.meetings import WidthResult

EXAMPLES = "Examples:  elbowroom bench meet  |  elbowroom bench meet --widths 0.95,1.2 --starts 5 --json"
FELL_SHORT = 1

_LEGEND = """passed of the meetings, within 15 s; back: metres, the farthest that one was driven back (0.3 is a step);
seconds until they had passed, in half of the meetings; ms: processor time of the longest step, with its plan unless
--live; late: frames shown later than a frame after they were due."""


def meet(
    *,
    width: Annotated[
        list[str] | None,
        typer.Option("--width", "--widths", metavar="N,...", help="Of the corridors, in metres (0.95 to 1.6)."),
    ] = None,
    starts: Annotated[
        int, typer.Option(help="Meetings in each corridor, of each kind; meeting K has the seed S + K.")
    ] = 20,
    seed: Annotated[int, typer.Option(help="Seed of the first meeting; those after it count up.")] = 0,
    live: Annotated[
        bool, typer.Option("--live", help="Plan beside playback, as a session does; meetings do not repeat exactly.")
    ] = False,
    jobs: Jobs = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Let two avatars meet in corridors, from random places and at random paces: both walk, or one of them stands.

    Exit code 0: all passed, nobody touched or was driven back by more than a step, and with --live no frame was late;
    1: not.
    """
    widths = WIDTHS if width is None else numbers_in("--width", width, "0.95,1.2")
    settings = MeetingSettings(widths, starts, seed, live=live)
    check_workers(None, jobs)
    from elbowroom.experiment.machine import machine_kind
    from elbowroom.experiment.meeting.meetings import as_dict, run_meetings

    compile_first(quiet=quiet)
    count = settings.count
    with chosen_workers(None, jobs, count) as workers, progress_bar("Meeting", count, quiet) as bar:
        results = run_meetings(settings, workers, bar.move)
    if json:
        print_json({"machine": machine_kind()} | as_dict(results))
    else:
        _show(results)
    if not all(result.well and not (live and result.late) for result in results):
        raise typer.Exit(FELL_SHORT)


def _show(results: "list[WidthResult]") -> None:
    from rich.console import Console
    from rich.table import Table

    from elbowroom.experiment.machine import machine_kind

    table = Table(title=f"Meeting in corridors ({machine_kind()})", title_justify="left", box=None)
    for column in ("who", "width, m", "passed", "touching", "driven back", "back", "seconds", "ms", "late"):
        table.add_column(column, justify="left" if column == "who" else "right")
    for row in results:
        table.add_row(
            row.kind, f"{row.width:g}", f"{row.passed} of {row.starts}", f"{row.touched}", f"{row.driven_back}",
            f"{row.back:.2f}", f"{row.seconds:.1f}", f"{row.frame_ms:.0f}", f"{row.late}",
        )  # fmt: skip
    Console().print(table)
    print(_LEGEND)
