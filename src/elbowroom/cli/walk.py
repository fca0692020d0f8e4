"""`elbowroom walk`: the paper's crossing test, without a screen."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = (
    "Examples:  elbowroom walk --scene c --queue 5  |  elbowroom walk --scene d --seed 1 --record run.elbow --json"
)


def walk(
    *,
    scene: Annotated[str, typer.Option(help="A stock scene by name (a, b, c, d, empty) or a scene file.")] = "a",
    planner: Annotated[str, typer.Option(help="How upper-body motion is searched: figure6.")] = "figure6",
    queue: Annotated[int, typer.Option(help="Size of the key-frame queue, |Q|.")] = 5,
    seed: Annotated[int, typer.Option(help="Varies the planner's chance, the start and the user's patience.")] = 0,
    avatar: Annotated[Path | None, typer.Option(help="A VRM or GLB humanoid instead of the stock avatar.")] = None,
    limit: Annotated[float, typer.Option(help="Seconds that the user has for the crossing.")] = 30.0,
    record: Annotated[Path | None, typer.Option(help="Keep the run in this file, for `elbowroom replay`.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")] = False,
) -> None:
    """Walk an avatar through a scene, faster than real time, and print how it went. Exit code 0: it got through."""
    raise NotImplementedError
