"""`elbowroom clips`: what motion files hold, and how an avatar performs it."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from elbowroom.cli.options import clips as clip_options
from elbowroom.cli.options.arguments import check_arguments, check_file
from elbowroom.cli.options.serving import OpenPage, Port
from elbowroom.cli.telling.output import print_json
from elbowroom.errors import InputError

if TYPE_CHECKING:
    from elbowroom.clips.clip import Clip
    from elbowroom.clips.files import MotionFile
    from elbowroom.clips.told import Told
    from elbowroom.server.stores.library import Library

EXAMPLES = (
    "Examples:  elbowroom clips walk.bvh  |  elbowroom clips moves.glb#Walk --play  |  elbowroom clips *.bvh --json"
)


def clips(
    *,
    files: Annotated[
        list[str], typer.Argument(help="Files in BVH, GLB, VRMA, X3D, USD; FILE#CLIP for one clip.", metavar="FILE...")
    ],
    play: Annotated[
        bool | None, typer.Option("--play/--list", help="Play them on the page; the default on a terminal.")
    ] = None,
    avatar: Annotated[Path | None, typer.Option(help="The avatar that plays them instead of the stock one.")] = None,
    unit: clip_options.Unit = None,
    up: clip_options.Up = None,
    fps: clip_options.Fps = None,
    port: Port = 8765,
    open_page: OpenPage = True,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object, and play nothing.")] = False,
) -> None:
    """List the motion clips in files, with what was recognised in each, and play them on an avatar in the browser.

    Exit code 2: a file holds no motion of a humanoid; the others are listed all the same.
    """
    check_arguments(files=[avatar], port=port)
    told = clip_options.told_by(unit, up, fps)
    rows, refusals = _rows(files, told)
    if json:
        print_json({"clips": rows, "refused": refusals})
    else:
        if rows:
            _print_table(rows)
        for file, reason in refusals.items():
            named = Path(file.split("#")[0]).name in reason
            typer.echo(f"elbowroom: {reason if named else f'{file}: {reason}'}", err=True)
    wanted = sys.stdout.isatty() if play is None else play
    if wanted and rows and not json:
        from elbowroom.cli.play import serve_until_interrupted

        serve_until_interrupted(lambda: _library(rows, told, avatar), "127.0.0.1", port, open_page=open_page)
    raise typer.Exit(2 if refusals else 0)


def _rows(references: list[str], told: "Told") -> tuple[list[dict[str, Any]], dict[str, str]]:
    """A row for every clip, and why files or clips were refused."""
    from elbowroom.clips.reference import split_reference

    rows: list[dict[str, Any]] = []
    refused: dict[str, str] = {}
    for reference in references:
        path, only = split_reference(reference)
        try:
            check_file(path)
            from elbowroom.clips.files import open_motion

            file = open_motion(path, told)
            names = list(file.clips) if only is None else [file.clip(only).name]
        except InputError as error:
            refused[reference] = str(error)
            continue
        for name in names:
            _add_row(rows, refused, file, name, path)
    return rows, refused


def _add_row(rows: list[dict[str, Any]], refused: dict[str, str], file: "MotionFile", name: str, path: Path) -> None:
    try:
        rows.append({"path": str(path), **_row(file.clip(name))})
    except InputError as error:
        refused[f"{path}#{name}"] = str(error)


def _row(clip: "Clip") -> dict[str, Any]:
    import numpy as np

    planning, figure = clip.planning, clip.figure
    strides = planning.track.strides
    return {
        "file": clip.file,
        "clip": clip.name,
        "format": clip.format,
        "frames": clip.frames,
        "fps": round(clip.fps, 2),
        "seconds": round(clip.motion.duration, 3),
        "up": figure.up,
        "unit": figure.unit_name,
        "metres_per_unit": float(f"{figure.unit:.5g}"),
        "head_height_m": round(figure.height, 3),
        "bones": len(figure.names),
        "loop": bool(strides.loop),
        "walk_m_per_s": round(strides.speed, 2),
        "on_the_spot": strides.on_the_spot,
        "trunk_lost_deg": round(float(np.rad2deg(planning.trunk_error.mean())), 1),
        "trunk_lost_most_deg": round(float(np.rad2deg(planning.trunk_error.max(initial=0.0))), 1),
        "arms_lost_deg": round(float(np.rad2deg(planning.arm_error.mean())), 1),
        "arms_lost_most_deg": round(float(np.rad2deg(planning.arm_error.max(initial=0.0))), 1),
    }


_COLUMNS = {
    "file": "file",
    "clip": "clip",
    "frames": "frames",
    "fps": "fps",
    "seconds": "s",
    "up": "up",
    "unit": "unit",
    "metres_per_unit": "m",
    "head_height_m": "head m",
    "walk_m_per_s": "walk m/s",
    "trunk_lost_deg": "trunk lost °",
    "arms_lost_deg": "arms lost °",
}


def _print_table(rows: list[dict[str, Any]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="dim")
    for name, title in _COLUMNS.items():
        table.add_column(title, justify="left" if name in ("file", "clip", "up", "unit") else "right")
    for row in rows:
        shown = row | {
            "clip": "" if row["format"] == "BVH" else row["clip"],
            "walk_m_per_s": row["walk_m_per_s"] or "-",
        }
        table.add_row(*(str(shown[name]) for name in _COLUMNS))
    console = Console(width=None if sys.stdout.isatty() else 140)
    console.print(table)


def _library(rows: list[dict[str, Any]], told: "Told", avatar: Path | None) -> "Library":
    """A server's library that begins with the first of the clips."""
    from dataclasses import replace

    from elbowroom.clips.files import open_motion
    from elbowroom.server.stores.library import Library

    library = Library.open("empty", avatar)
    files = {row["path"]: open_motion(Path(row["path"]), told) for row in rows}
    stored = [library.clips.add_file(files[row["path"]], row["clip"])[0] for row in rows]
    return replace(library, clip=stored[0].id)
