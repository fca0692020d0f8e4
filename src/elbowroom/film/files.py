"""Films as files: WebM, MP4 (by ffmpeg, where it is installed), GIF, and one picture with sixteen moments."""

import io
import math
import subprocess
from collections.abc import Callable
from functools import partial
from pathlib import Path

from PIL import Image

from elbowroom.errors import InputError
from elbowroom.film.gif import write_gif
from elbowroom.film.page import FilmedPage
from elbowroom.film.settings import ACROSS, MOMENTS
from elbowroom.film.webm import Packet, write_webm

MOST_PICTURES = 20_000

Progress = Callable[[int, int], object]


def write_film(page: FilmedPage, path: Path, fps: float, speed: float, progress: Progress) -> int:
    """Film the whole recording at `fps` pictures a second, `speed` times as fast as it was; how many pictures."""
    kind = path.suffix.lower()
    if kind == ".png":
        return _write_sheet(page, path, progress)
    count = math.floor(page.duration / speed * fps + 1e-6) + 1
    if count > MOST_PICTURES:
        raise InputError(
            f"{path}: {count} pictures are more than {MOST_PICTURES}: ask for a lower --fps or a higher --speed"
        )
    writer = {".webm": _write_webm, ".gif": _write_gif, ".mp4": _write_mp4}[kind]

    def picture(number: int) -> bytes:
        progress(number, count)
        return page.picture(min(number * speed / fps, page.duration))

    writer(page, path, fps, [partial(picture, number) for number in range(count)])
    return count


Pictures = list[Callable[[], bytes]]


def _write_webm(page: FilmedPage, path: Path, fps: float, pictures: Pictures) -> None:
    codec = page.begin_encoding(fps)
    packets: list[Packet] = []
    for number, picture in enumerate(pictures):
        packets += page.encode(picture(), number / fps, number)
    packets += page.encode(None)
    with path.open("wb") as file:
        write_webm(file, packets, page.size, codec)


def _write_gif(page: FilmedPage, path: Path, fps: float, pictures: Pictures) -> None:  # noqa: ARG001
    write_gif(path, fps, [picture() for picture in pictures])


def _write_mp4(page: FilmedPage, path: Path, fps: float, pictures: Pictures) -> None:  # noqa: ARG001
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", f"{fps:g}", "-i", "-"]
    command += [
        "-an",
        "-vf",
        "pad=ceil(iw/2)*2:ceil(ih/2)*2",
        "-pix_fmt",
        "yuv420p",
        "-movflags",
        "+faststart",
        str(path),
    ]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdin is not None
    try:
        for picture in pictures:
            process.stdin.write(picture())
    except BrokenPipeError:
        pass  # ffmpeg says why
    _, said = process.communicate()
    if process.returncode != 0:
        lines = said.decode("utf-8", "replace").strip().splitlines()
        raise InputError(f"{path}: ffmpeg cannot write it: {lines[-1] if lines else 'no reason given'}")


def _write_sheet(page: FilmedPage, path: Path, progress: Progress) -> int:
    """Sixteen moments, evenly spaced, in one picture of the page's size."""
    width, height = (length // ACROSS for length in page.size)
    sheet = Image.new("RGB", (width * ACROSS, height * ACROSS))
    for number in range(MOMENTS):
        progress(number, MOMENTS)
        drawn = _image(page.picture(page.duration * number / (MOMENTS - 1)))
        tile = drawn.resize((width, height), Image.Resampling.LANCZOS)
        sheet.paste(tile, (width * (number % ACROSS), height * (number // ACROSS)))
    sheet.save(path)
    return MOMENTS


def _image(picture: bytes) -> Image.Image:
    return Image.open(io.BytesIO(picture)).convert("RGB")
