"""A tour from above: the room that there is, the way that was walked, the places that were visited."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from elbowroom.experiment.tour.tour import TourResult
from elbowroom.planning.navigation.room_map import RoomMap

Floats = NDArray[np.float64]
Picture = NDArray[np.uint8]

_SIDE, _LETTERS = 900, 16  # pixels of the longer side, about; of a letter
_STANDS, _ROOMY, _TIGHT = (66, 70, 82), (224, 238, 228), (250, 214, 180)
_WAY, _REACHED, _LOST = (40, 96, 190), (22, 130, 90), (205, 60, 50)


def tour_picture(room: RoomMap, slim: float, roots: Floats, result: TourResult) -> Picture:
    """A picture (height, width, 3) of root states (F, 7) over a map; +X points left, +Z up, as who sets out sees it.

    What is too narrow for legs (less than `slim` metres to each side) is dark; what is narrow is tinted.
    """
    zoom, widest = max(1, _SIDE // max(room.shape)), _widest(room)
    share = np.clip((widest - slim) / (widest.max() - slim + 1e-9), 0.0, 1.0)[..., None]
    seen = np.array(_TIGHT) + share * (np.array(_ROOMY) - np.array(_TIGHT))
    seen[widest < slim] = _STANDS
    made = Image.fromarray(np.kron(seen[::-1, ::-1].astype(np.uint8), np.ones((zoom, zoom, 1), np.uint8)))
    draw, letters = ImageDraw.Draw(made), ImageFont.load_default(_LETTERS)

    def at(places: Floats) -> Floats:
        own = (places - (room.area.low_x, room.area.low_z)) / room.cell + 0.5
        pixels: Floats = (np.array(room.shape[::-1]) - own) * zoom
        return pixels

    draw.line([(x, y) for x, y in at(roots[:, :2]).tolist()], fill=_WAY, width=3, joint="curve")
    for number, leg in enumerate(result.legs, 1):
        x, y = at(np.array((leg.target[0], leg.target[-1]))).tolist()
        draw.ellipse((x - 11, y - 11, x + 11, y + 11), fill=_REACHED if leg.arrived else _LOST)
        draw.text((x, y), str(number), (255, 255, 255), letters, anchor="mm")
    return np.asarray(made)


def _widest(room: RoomMap) -> NDArray[np.float32]:
    """The room over each point, rows and columns, on the floor that has most of it; 0 where there is none."""
    seen = np.zeros(room.shape[0] * room.shape[1], np.float32)
    np.maximum.at(seen, room.surfaces.points, room.room)
    return seen.reshape(room.shape)
