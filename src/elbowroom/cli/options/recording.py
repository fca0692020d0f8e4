"""The options of commands that take a recording."""

from pathlib import Path
from typing import Annotated

import typer

HOW_MADE = "A file written by `elbowroom walk --record`."

RecordingFile = Annotated[Path, typer.Argument(help=HOW_MADE)]
ItsAvatar = Annotated[Path | None, typer.Option("--avatar", help="The avatar's file, where it is not the stock one.")]
