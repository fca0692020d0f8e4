"""The floors of a place from above, in one picture: what can be walked on, what stands there, narrow passages."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from elbowroom.world.places.floors import Floor
from elbowroom.world.places.passages import passages_of
from elbowroom.world.places.survey import Survey

Picture = NDArray[np.uint8]
Colour = tuple[int, int, int]

_PAPER, _INK = 255, (40, 44, 52)
_THERE, _WALKABLE, _BLOCKED = (228, 226, 220), (152, 205, 164), (66, 70, 82)
_NARROW, _START = (214, 90, 60), (40, 96, 190)
_SIDE = 900  # pixels of a floor's longer side, about
_NARROWEST = 420  # pixels of a picture, for its title
_TOP, _GAP, _LETTERS, _SMALL = 56, 24, 18, 14  # pixels


def floor_plan(survey: Survey) -> Picture:
    """A picture (height, width, 3), the floors from the lowest at the left; +X points right, +Z down."""
    floors = survey.floors or (survey.ground,)
    return np.concatenate([_framed(_drawn(survey, floor)) for floor in floors], axis=1)


def _drawn(survey: Survey, floor: Floor) -> Picture:
    columns = survey.columns
    zoom, thin = max(1, _SIDE // max(columns.shape)), max(1, math.ceil(max(columns.shape) / _SIDE))
    seen = np.full((*columns.shape, 3), 255, np.uint8)
    for there, colour in ((floor.there, _THERE), (floor.walkable, _WALKABLE), (floor.blocked, _BLOCKED)):
        seen[there] = colour
    seen = np.repeat(np.repeat(seen[::thin, ::thin], zoom, axis=0), zoom, axis=1).transpose(1, 0, 2)
    picture = np.full((_TOP + seen.shape[0], max(seen.shape[1], _NARROWEST), 3), 255, np.uint8)
    picture[_TOP:, : seen.shape[1]] = seen
    made = Image.fromarray(picture)
    to_pixel = zoom / (thin * columns.cell)

    def at(x: float, z: float) -> tuple[float, float]:
        return (x - columns.origin[0]) * to_pixel, (z - columns.origin[1]) * to_pixel + _TOP

    _mark(ImageDraw.Draw(made), survey, floor, at, to_pixel)
    return np.asarray(made)


def _mark(
    draw: ImageDraw.ImageDraw,
    survey: Survey,
    floor: Floor,
    at: Callable[[float, float], tuple[float, float]],
    to_pixel: float,
) -> None:
    """Title, passages and, on the floor that is walked on, the start with the way that it looks."""
    walked = ", walked on" if floor is survey.ground else ""
    title = f"{survey.place.name}  {floor.height:+.2f} m{walked}: {floor.area:.1f} sq m"
    draw.text((2, 2), title, _INK, ImageFont.load_default(_LETTERS))
    draw.text((2, 28), f"one metre: {to_pixel:.3g} pixels", _INK, ImageFont.load_default(_SMALL))
    for passage in passages_of(floor):
        x, y = at(passage.x, passage.z)
        radius = max(4.0, 0.5 * passage.width * to_pixel)
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), outline=_NARROW, width=2)
        draw.text((x, y - radius - 2), f"{passage.width:.2f} m", _NARROW, ImageFont.load_default(_SMALL), anchor="md")
    if floor is survey.ground:
        x, z, heading, way = survey.beginning
        here, there = at(x, z), at(x + way * math.sin(heading), z + way * math.cos(heading))
        draw.line((*here, *there), _START, 2)
        draw.ellipse((here[0] - 6, here[1] - 6, here[0] + 6, here[1] + 6), fill=_START)


def _framed(picture: Picture) -> Picture:
    """With a margin to every side."""
    return np.pad(picture, ((_GAP, _GAP), (_GAP, _GAP), (0, 0)), constant_values=_PAPER)
