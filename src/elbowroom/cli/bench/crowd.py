"""`elbowroom bench crowd`: how many avatars one core carries."""

from typing import Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.lists import whole_numbers_in
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, print_row, progress_bar
from elbowroom.experiment.bench.settings import CrowdSettings

EXAMPLES = "Examples:  elbowroom bench crowd  |  elbowroom bench crowd --avatars 1,10,100 --json"


def crowd(
    *,
    avatars: Annotated[list[str] | None, typer.Option(metavar="N,...", help="Sizes of the crowds (1,10,100).")] = None,
    seconds: Annotated[float, typer.Option(help="Seconds for which each crowd is measured.")] = 2.4,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Walk and stand crowds of one avatar on one thread: memory and time to make each, and how many keep 60 Hz.

    They set out one after the other, so that their plans do not fall into the same frame.
    """
    settings = CrowdSettings(whole_numbers_in("--avatars", avatars or ["1,10,100"], "1,10,100"), seconds)
    from elbowroom.experiment.bench.crowd import amount, run
    from elbowroom.experiment.machine import machine_kind

    compile_first(quiet=quiet)
    with progress_bar("Walking", amount(settings), quiet) as bar:
        report = run(settings, bar.move)
    if json:
        print_json({"machine": machine_kind()} | report.as_dict())
        return
    for cost in report.costs:
        rows = {
            "to make one more": f"{cost.made_ms:.1f} ms, {cost.own_mb:.2f} MB of its own",
            "a frame of all": f"{cost.frame_ms:.2f} ms; 99 %: {cost.frame_p99_ms:.2f}, worst {cost.frame_worst_ms:.2f}",
            "keep 60 Hz on one core": f"{cost.at_60_hz}",
        }
        print_row(f"{cost.avatars} {cost.what} ({machine_kind()})", rows)
