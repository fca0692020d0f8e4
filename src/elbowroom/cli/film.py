"""`elbowroom film`: a recording as a film."""

import re
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.replay import library_of
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, progress_bar
from elbowroom.cli.telling.spoken import said
from elbowroom.errors import InputError

EXAMPLES = (
    "Examples:  elbowroom film run.elbow -o walk.webm --camera front  |  elbowroom film run.elbow -o sheet.png --sheet"
)
CAMERAS = ("behind", "side", "front", "above", "orbit", "shoulder")
QUALITIES = ("high", "medium", "low")
_SMALLEST, _LARGEST = 64, 4096  # pixels


def film(
    recording: Annotated[Path, typer.Argument(help="A file written by `elbowroom walk --record`.")],
    *,
    output: Annotated[Path, typer.Option("--output", "-o", help="The film: .mp4, .webm, .gif, or a .png sheet.")],
    camera: Annotated[str, typer.Option(help=f"From where: {', '.join(CAMERAS)}.")] = "side",
    size: Annotated[str, typer.Option(help="Width and height in pixels.")] = "1280x720",
    fps: Annotated[float | None, typer.Option(help="Pictures a second: 30, of a GIF 15.")] = None,
    speed: Annotated[float, typer.Option(help="How many times as fast as it was, from 0.1 to 10.")] = 1.0,
    sheet: Annotated[bool, typer.Option("--sheet", help="One picture with 16 moments (.png).")] = False,
    overlays: Annotated[str, typer.Option(help="What is drawn besides: none, capsules, footprints.")] = "none",
    dark: Annotated[bool, typer.Option("--dark", help="In dark colours.")] = False,
    quality: Annotated[str, typer.Option(help="high, medium or low; low is quickest.")] = "high",
    avatar: Annotated[Path | None, typer.Option(help="The avatar's file, where it is not the stock one.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")] = False,
) -> None:
    """Film a recording as the page shows it, in a headless Chromium or Chrome, frame by frame on any machine."""
    check_arguments(files=[recording, avatar])
    pixels, rate = _size(size), _rate(output, fps, sheet)
    for name, value, known in (("camera", camera, CAMERAS), ("quality", quality, QUALITIES)):
        if value not in known:
            raise InputError(f"--{name} {value}: there are {', '.join(known)}")
    if not 0.1 <= speed <= 10.0:
        raise InputError(f"--speed {speed:g}: allowed are 0.1 to 10")
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.film.files import check_output, write_film
    from elbowroom.film.page import Look, filmed_page, served

    check_output(output)
    recorded, look = Recording(recording), Look(pixels, camera, overlays, dark, quality)
    compile_first(quiet=quiet)
    with (
        progress_bar(said("Filming"), 1.0, quiet) as bar,
        closing(library_of(recorded, avatar)) as library,
        served(library) as url,
        filmed_page(url, look) as page,
    ):
        seconds = page.duration
        count = write_film(page, output, rate, speed, lambda done, all_: bar.move(done / all_, f"{done} of {all_}"))
    if json:
        print_json({"film": str(output), "pictures": count, "fps": rate, "seconds": seconds, "size": list(pixels)})
    else:
        print(said("{0}: {1} pictures of {2} s", output, count, f"{seconds:.1f}"))


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    pixels = (int(found[1]), int(found[2])) if found else (0, 0)
    if not all(_SMALLEST <= length <= _LARGEST for length in pixels):
        raise InputError(f"--size {text}: width and height from {_SMALLEST} to {_LARGEST}, such as 1280x720")
    return pixels


def _rate(output: Path, fps: float | None, sheet: bool) -> float:
    kind = output.suffix.lower()
    if sheet != (kind == ".png"):
        raise InputError(f"{output}: a sheet is a .png, and a .png is a sheet: give both --sheet and such a name")
    rate = fps if fps is not None else 15.0 if kind == ".gif" else 30.0
    if not 1.0 <= rate <= 60.0:
        raise InputError(f"--fps {rate:g}: allowed are 1 to 60")
    return rate
