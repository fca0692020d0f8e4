"""Options of commands that do many tasks: on how many processes of this machine, or on which cluster."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from elbowroom.experiment.parallel import Workers

Jobs = Annotated[int | None, typer.Option(help="Tasks at once (as many as there are cores); 1 gives the truest times.")]
Cluster = Annotated[
    str | None,
    typer.Option(metavar="local|HOST:PORT", help="Do it on a Ray cluster: one of this machine, or one that runs."),
]


def check_workers(cluster: str | None, jobs: int | None = None) -> None:
    """Raises `InputError` for what cannot be a cluster or a number of tasks, before anything heavy is imported."""
    from elbowroom.experiment.parallel import check_jobs

    if jobs is not None:
        check_jobs(jobs)
    if cluster is not None:
        from elbowroom.cluster.connection import check_address

        check_address(cluster)


@contextmanager
def chosen_workers(cluster: str | None, jobs: int | None, most: int | None = None) -> "Iterator[Workers]":
    """Those that the options name; of this machine's processes at most `most`, the number of tasks."""
    from elbowroom.experiment.parallel import usable_cores, workers_here

    if cluster is None:
        cores = usable_cores()
        yield workers_here(min(cores, most or cores) if jobs is None else jobs)
        return
    from elbowroom.cluster.connection import connected

    with connected(cluster, lambda line: typer.echo(f"elbowroom: {line}", err=True), jobs) as workers:
        yield workers
