"""`elbowroom bench cluster`: how well more workers are used."""

from typing import Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.lists import whole_numbers_in
from elbowroom.cli.options.workers import check_workers
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, print_row, progress_bar

EXAMPLES = "Examples:  elbowroom bench cluster  |  elbowroom bench cluster --workers 1,2 --courses 30 --json"


def cluster(
    *,
    address: Annotated[
        str,
        typer.Option("--cluster", metavar="local|HOST:PORT", help="A Ray cluster: of this machine, or one that runs."),
    ] = "local",
    workers: Annotated[
        list[str] | None, typer.Option(metavar="N,...", help="Numbers of workers to compare (1,2,4).")
    ] = None,
    level: Annotated[int, typer.Option(help="Of the courses that are walked, 1 to 5.")] = 3,
    courses: Annotated[int, typer.Option(help="How many each crew walks.")] = 12,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Walk the same courses with more and more workers of a Ray cluster: how busy they are, what tasks cost beside."""
    check_workers(address)
    from elbowroom.cluster.bench_settings import ClusterSettings

    settings = ClusterSettings(address, whole_numbers_in("--workers", workers or ["1,2,4"], "1,2,4"), level, courses)
    compile_first(quiet=quiet)
    from elbowroom.cluster.bench import run

    with progress_bar("Walking", len(settings.workers), quiet) as bar:
        report = run(settings, bar.move, lambda line: typer.echo(f"elbowroom: {line}", err=True))
    if json:
        print_json(report.as_dict())
        return
    alone = report.crews[0]
    for crew in report.crews:
        faster = f"{alone.seconds / crew.seconds:.2f} times as fast as {alone.workers}"
        rows = {
            "courses": f"{courses} of level {level} in {crew.seconds:.1f} s: {faster}",
            "a course": f"{crew.course_seconds:.2f} s of a worker, {report.record_bytes / 1e3:.1f} kB of result",
            "walking": f"{100 * crew.busy:.0f} % of the workers' time",
            "overhead": f"{crew.overhead_ms:.2f} ms a task",
        }
        print_row(f"{crew.workers} at once ({report.machine})", rows)
