"""`elbowroom bench steer`: what planning costs while a user really steers, and how soon the motion follows."""

import json as json_text
from collections.abc import Iterator
from dataclasses import asdict
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.lists import names_in
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import Bar, print_json, print_row, progress_bar
from elbowroom.experiment.bench.settings import STEERED, SteerSettings

if TYPE_CHECKING:
    from elbowroom.cli.doctor.session_cost import SessionCost
    from elbowroom.experiment.bench.steer import SteerReport

EXAMPLES = """Examples:  elbowroom bench steer  |  elbowroom bench steer --scene bends --scene "d, keys" --json  |
elbowroom bench steer --scene bends --sessions 4"""

_WIDTH = 120  # characters: of the table
_LIVE = ("bends", "d, keys")
_LEGEND = """ms: processor time of a planning call, median, 99 %, worst; checks: capsules and places held against
obstacles, nodes: of the search, median and worst of a call; progress: share of the way asked for that was made good."""


def steer(
    *,
    scene: Annotated[
        list[str] | None, typer.Option("--scene", "--scenes", metavar="NAME,...", help="What to steer through (all).")
    ] = None,
    rounds: Annotated[int, typer.Option(help="Walks through each, every one from another start.")] = 3,
    seconds: Annotated[float, typer.Option(help="The longest walk; with --sessions, how long to steer.")] = 15.0,
    sessions: Annotated[int, typer.Option(min=0, max=8, help="Steer so many live sessions instead.")] = 0,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Steer through bends, slaloms and scenes by scripted hands, and say what each planning call costs.

    With `--sessions`, a real server is steered by as many clients, and it is said how soon the motion that is shown is
    the one that was asked for.
    """
    settings = SteerSettings(names_in(scene or (_LIVE if sessions else ()), STEERED), seconds, rounds)
    from elbowroom.experiment.bench.steer import amount, run
    from elbowroom.experiment.machine import machine_kind

    compile_first(quiet=quiet)
    with progress_bar("Steering", len(settings.scenes) if sessions else amount(settings), quiet) as bar:
        if sessions:
            live = dict(_live(settings, sessions, bar))
        else:
            report = run(settings, bar.move)
    if sessions and json:
        print_json({"machine": machine_kind()} | {name: asdict(cost) for name, cost in live.items()})
    elif sessions:
        _show_live(live)
    elif json:
        print_json({"machine": machine_kind()} | report.as_dict())
    else:
        _show(report)


def _live(settings: SteerSettings, sessions: int, bar: Bar) -> "Iterator[tuple[str, SessionCost]]":
    """What live sessions in each scene come to."""
    from elbowroom.cli.doctor.session_cost import measure_session
    from elbowroom.experiment.bench.steer_scenes import steered_scenes

    for done, steered in enumerate(steered_scenes(settings.scenes), 1):
        with TemporaryDirectory() as folder:
            file = Path(folder, "scene.json")
            file.write_text(json_text.dumps(steered.scene.to_dict()), "utf-8")
            yield (
                steered.name,
                measure_session(settings.seconds, str(file), sessions, partial(steered.hand, steered.route)),
            )
        bar.move(done)


def _show(report: "SteerReport") -> None:
    from rich.console import Console
    from rich.table import Table

    from elbowroom.experiment.machine import machine_kind

    table = Table(title=f"Steering ({machine_kind()})", title_justify="left", box=None)
    for column in ("where", "calls", "ms", "checks", "nodes", "seconds", "stuck s", "touching", "progress"):
        table.add_column(column, justify="left" if column == "where" else "right")
    for row in (*report.scenes, report.overall):
        table.add_row(
            row.scene,
            str(row.calls),
            f"{row.median_ms:.2f}, {row.p99_ms:.1f}, {row.worst_ms:.1f}",
            f"{row.median_checks:.0f}, {row.worst_checks}",
            f"{row.median_nodes:.0f}, {row.worst_nodes}",
            f"{row.seconds:.1f}",
            f"{row.stuck_seconds:.1f}",
            str(row.touching_frames),
            f"{100.0 * row.progress:.0f} %",
        )
    console = Console()
    (console if console.width >= _WIDTH else Console(width=_WIDTH)).print(table)
    print(_LEGEND)


def _show_live(live: "dict[str, SessionCost]") -> None:
    for name, cost in live.items():
        rows = {
            "command to shown motion": f"{cost.answer_ms_p50:.0f} ms (half), {cost.answer_ms_p99:.0f} (99 %), "
            f"{cost.answer_ms_max:.0f} (all); aim {cost.answer_aim_ms:g} at 99 %",
            "plans too late": str(cost.late_plans),
            "frames": f"{cost.frames_per_second:.1f} a second, 99 % within {cost.late_ms_p99:.1f} ms of their time",
            "processor": f"{cost.cpu_percent:.1f} % of one core each",
        }
        print_row(f"{name}: {cost.sessions} live session{'s' * (cost.sessions > 1)}, {cost.seconds:.0f} s", rows)
