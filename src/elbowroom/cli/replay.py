"""`elbowroom replay`: a recording repeated bit for bit."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = "Examples:  elbowroom replay run.elbow  |  elbowroom replay run.elbow --avatar alice.vrm --json"


def replay(
    recording: Annotated[Path, typer.Argument(help="A file written by `elbowroom walk --record`.")],
    avatar: Annotated[Path | None, typer.Option(help="The avatar's file, where it is not the stock one.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")] = False,
) -> None:
    """Run the recorded commands again and compare every frame. Exit code 0: identical, 1: not."""
    raise NotImplementedError
