"""GIF films: all pictures share one palette, so nothing changes its colour from one picture to the next."""

import io
from pathlib import Path

from PIL import Image

_ASKED = 16  # pictures that the palette is made of
_WIDTH = 320  # pixels of each
_COLOURS = 256
_ROUNDS = 2  # in which each colour moves to the mean of what it stands for; colours far from all others stay


def write_gif(path: Path, fps: float, pictures: list[bytes]) -> None:
    """Write pictures (files of one size, in any format that Pillow reads) as a film that plays over and over."""
    palette = _palette(pictures)
    frames = (_opened(picture).quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures)
    first = next(frames)
    first.save(path, save_all=True, append_images=frames, duration=1000.0 / fps, loop=0, optimize=False)


def _palette(pictures: list[bytes]) -> Image.Image:
    """An image whose palette suits them all."""
    count = min(len(pictures), _ASKED)
    some = [_opened(pictures[k * (len(pictures) - 1) // max(count - 1, 1)]) for k in range(count)]
    width = min(_WIDTH, some[0].width)
    size = (width, max(1, some[0].height * width // some[0].width))
    sheet = Image.new("RGB", (size[0], size[1] * count))
    for k, picture in enumerate(some):
        sheet.paste(picture.resize(size, Image.Resampling.NEAREST), (0, size[1] * k))
    return sheet.quantize(_COLOURS, method=Image.Quantize.MAXCOVERAGE, kmeans=_ROUNDS)


def _opened(picture: bytes) -> Image.Image:
    return Image.open(io.BytesIO(picture)).convert("RGB")
