"""Words in pictures, in the outline font that Pillow brings (Aileron, CC0)."""

import re
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

Colour = tuple[int, int, int]

_LEADING = 1.22  # from one line to the next, of the size


class Lettering:
    """Writes into a copy of an RGB picture (height, width, 3); places and sizes are in pixels."""

    def __init__(self, picture: NDArray[np.uint8]) -> None:
        self._picture = Image.fromarray(picture)
        self._draw = ImageDraw.Draw(self._picture)

    def centred(self, text: str, x: int, top: int, size: int, colour: Colour) -> None:
        """One line with its middle at `x`."""
        self._draw.text((x, top), text, colour, ImageFont.load_default(size), anchor="ma")

    def wrapped(self, text: str, left: int, top: int, width: int, size: int, colour: Colour) -> int:
        """Lines no wider than `width`, one below the other; gives where the next one would begin."""
        font = ImageFont.load_default(size)
        for line in _lines(text, lambda words: self._draw.textlength(words, font) <= width):
            self._draw.text((left, top), line, colour, font)
            top += round(_LEADING * size)
        return top

    def image(self) -> NDArray[np.uint8]:
        """The picture with what was written."""
        return np.asarray(self._picture)


def _lines(text: str, fits: Callable[[str], bool], most: int = 4) -> list[str]:
    """A text in lines that fit, broken after separators, before capitals, else anywhere."""
    lines = [""]
    for piece in re.findall(r"[^ _-][^ _A-Z-]*[ _-]?|[ _-]", text):
        if fits(lines[-1] + piece.rstrip()) or not lines[-1]:
            lines[-1] += piece
        else:
            lines.append(piece)
        while not fits(lines[-1].rstrip()) and len(lines[-1]) > 1:
            cut = next(n for n in range(len(lines[-1]) - 1, 0, -1) if n == 1 or fits(lines[-1][:n]))
            lines[-1:] = [lines[-1][:cut], lines[-1][cut:]]
    return lines[:most]
