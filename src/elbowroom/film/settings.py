"""What may be chosen about a film: how the page shows the recording, and what file it becomes."""

import shutil
from dataclasses import dataclass
from pathlib import Path

from elbowroom.errors import InputError

CAMERAS = ("behind", "side", "front", "above", "orbit", "shoulder")
QUALITIES = ("high", "medium", "low")
OVERLAYS = ("capsules", "path", "ghosts", "goal", "nearest", "plan", "footprints")  # as the page has them
KINDS = (".mp4", ".webm", ".gif", ".png")
ACROSS = 4  # pictures beside one another on a sheet, and below
MOMENTS = ACROSS**2  # of a sheet
_SMALLEST, _LARGEST = 64, 4096  # pixels


@dataclass(frozen=True)
class Look:
    """How the page shows a recording; raises `InputError` for what it cannot show."""

    size: tuple[int, int] = (1280, 720)  # pixels
    camera: str = "side"
    overlays: str = "none"  # "all", or some of `OVERLAYS` with commas between them
    dark: bool = False
    quality: str = "high"

    def __post_init__(self) -> None:
        if not all(_SMALLEST <= length <= _LARGEST for length in self.size):
            size = "x".join(map(str, self.size))
            raise InputError(f"--size {size}: width and height from {_SMALLEST} to {_LARGEST}, such as 1280x720")
        _check("camera", self.camera, CAMERAS)
        _check("quality", self.quality, QUALITIES)
        for overlay in [] if self.overlays in ("none", "all") else self.overlays.split(","):
            _check("overlays", overlay, ("none", "all", *OVERLAYS))


def _check(name: str, value: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise InputError(f"--{name} {value[:40]}: there are {', '.join(known)}")


def drawn_scale(path: Path) -> float:
    """How large pictures are drawn, as a part of a film's size: those of a sheet no larger than it shows them."""
    return 1.0 / ACROSS if path.suffix.lower() == ".png" else 1.0


def check_output(path: Path) -> None:
    """Raises `InputError` where a film cannot be written to a path of this name on this machine."""
    if path.suffix.lower() not in KINDS:
        raise InputError(f"{path}: films are {', '.join(KINDS)} (a sheet of {MOMENTS} moments)")
    if path.suffix.lower() == ".mp4" and shutil.which("ffmpeg") is None:
        raise InputError(
            f"{path}: mp4 needs the program ffmpeg, which is not installed; .webm, .gif and .png need nothing"
        )
    if not path.parent.is_dir():
        raise InputError(f"{path}: the folder {path.parent} does not exist")
