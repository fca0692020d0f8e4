"""`elbowroom film`: a recording as a film."""

import re
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.recording import ItsAvatar, RecordingFile
from elbowroom.cli.replay import library_of
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, progress_bar
from elbowroom.cli.telling.spoken import said
from elbowroom.errors import InputError
from elbowroom.film.settings import CAMERAS, Look, check_output, drawn_scale

EXAMPLES = (
    "Examples:  elbowroom film run.elbow -o walk.webm --camera front  |  elbowroom film run.elbow -o sheet.png --sheet"
)


def film(
    recording: RecordingFile,
    *,
    output: Annotated[
        Path, typer.Option("--out", "--output", "-o", help="The film: .mp4, .webm, .gif, or a .png sheet.")
    ],
    camera: Annotated[str, typer.Option(help=f"From where: {', '.join(CAMERAS)}.")] = "side",
    size: Annotated[str, typer.Option(help="Width and height in pixels.")] = "1280x720",
    fps: Annotated[float | None, typer.Option(help="Pictures a second: 30, of a GIF 15.")] = None,
    speed: Annotated[float, typer.Option(help="How many times as fast as it was, from 0.1 to 10.")] = 1.0,
    sheet: Annotated[bool, typer.Option("--sheet", help="One picture with 16 moments (.png).")] = False,
    overlays: Annotated[str, typer.Option(help="Drawn besides: none, all, capsules, footprints, ...")] = "none",
    dark: Annotated[bool, typer.Option("--dark", help="In dark colours.")] = False,
    quality: Annotated[str, typer.Option(help="high, medium or low; low is quickest.")] = "high",
    avatar: ItsAvatar = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Film a recording as the page shows it, in a headless Chromium or Chrome, frame by frame on any machine."""
    check_arguments(files=[recording, avatar])
    look, rate = Look(_size(size), camera, overlays, dark, quality), _rate(output, fps, sheet)
    if not 0.1 <= speed <= 10.0:
        raise InputError(f"--speed {speed:g}: allowed are 0.1 to 10")
    check_output(output)
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.film.files import write_film
    from elbowroom.film.page import filmed_page, served

    recorded = Recording(recording)
    with closing(library_of(recorded, avatar)) as library:
        compile_first(quiet=quiet)
        with (
            progress_bar(said("Filming"), 1.0, quiet) as bar,
            served(library) as url,
            filmed_page(url, look, drawn_scale(output)) as page,
        ):
            seconds = page.duration
            count = write_film(page, output, rate, speed, lambda done, all_: bar.move(done / all_, f"{done} of {all_}"))
    if json:
        told = {"film": str(output), "pictures": count, "fps": rate, "seconds": seconds, "size": list(look.size)}
        print_json(told | {"note": recorded.note})
        return
    print(said("{0}: {1} pictures of {2} s", output, count, f"{seconds:.1f}"))
    if recorded.note is not None:
        print(said("not whole: {0}", recorded.note))


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    if found is None:
        raise InputError(f"--size {text}: is no width and height in pixels, such as 1280x720")
    return int(found[1]), int(found[2])


def _rate(output: Path, fps: float | None, sheet: bool) -> float:
    kind = output.suffix.lower()
    if sheet != (kind == ".png"):
        raise InputError(f"{output}: a sheet is a .png, and a .png is a sheet: give both --sheet and such a name")
    rate = fps if fps is not None else 15.0 if kind == ".gif" else 30.0
    if not 1.0 <= rate <= 60.0:
        raise InputError(f"--fps {rate:g}: allowed are 1 to 60")
    return rate
