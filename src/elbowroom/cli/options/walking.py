"""The options by which commands choose where one walks, by which planner, and where the run is kept."""

from pathlib import Path
from typing import Annotated

import typer

from elbowroom.planning.names import BUILT_IN

SCENE_HELP = (
    "A scene by name (a, b, c, d, beam, doorway, traffic, shapes, empty), a course (gauntlet:5:1013), a scene file, "
    "or a model of a place (GLB, X3D, VRML, OBJ, STL, PLY, USD)."
)

SceneName = Annotated[str, typer.Option("--scene", help=SCENE_HELP)]
Planner = Annotated[str, typer.Option(help=f"How upper-body motion is searched: {' or '.join(BUILT_IN)}.")]
Queue = Annotated[
    int,
    typer.Option(help="How many key frames are planned ahead (the queue's size, |Q|): 2 to 32; the paper has 3 to 7."),
]
Record = Annotated[Path | None, typer.Option(help="Keep the run in this file, for `elbowroom replay`.")]
