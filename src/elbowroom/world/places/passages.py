"""The narrowest passages of a floor: where two roomy regions of it meet.

Regions grow from the roomiest cells to the tighter ones; the cell at which two that are large enough become one is the
passage between them, and the room there is half its width.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.places.floors import Floor

_WIDEST, _NARROWEST = 1.4, 0.3  # metres of a passage that is told
_LEAST_AREA = 0.75  # m² of each of the two regions that it joins
_AROUND = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


@dataclass(frozen=True)
class Passage:
    """A narrow place between two regions."""

    x: float  # metres
    z: float
    width: float  # metres, as exact as a cell


def passages_of(floor: Floor, most: int = 8) -> list[Passage]:
    """The narrowest passages between regions of a floor, the narrowest first."""
    from scipy import ndimage  # slow to import, and not needed on a plain

    room, cell = floor.room, floor.columns.cell
    numbers, count = ndimage.label(room >= 0.5 * _WIDEST, np.ones((3, 3), bool))
    groups = _Groups((np.bincount(numbers.reshape(-1), minlength=count + 1) * cell * cell).tolist())
    order = _tight_cells(room)
    found = []
    for ix, iz in order.tolist():
        around = {
            groups.find(int(numbers[ix + dx, iz + dz]))
            for dx, dz in _AROUND
            if 0 <= ix + dx < room.shape[0] and 0 <= iz + dz < room.shape[1] and numbers[ix + dx, iz + dz] > 0
        }
        own = groups.join(around, cell * cell)
        numbers[ix, iz] = own.number
        if own.second_largest >= _LEAST_AREA:
            x, z = floor.columns.middle(ix, iz)
            found.append(Passage(x, z, 2.0 * float(room[ix, iz])))
    return sorted(found, key=lambda passage: passage.width)[:most]


def _tight_cells(room: NDArray[np.float64]) -> NDArray[np.int64]:
    """The cells (N, 2) in which a passage may lie, the roomiest first."""
    tight = np.argwhere((room < 0.5 * _WIDEST) & (room >= 0.5 * _NARROWEST))
    order = np.argsort(-room[tight[:, 0], tight[:, 1]], kind="stable")
    sorted_cells: NDArray[np.int64] = tight[order]
    return sorted_cells


@dataclass(frozen=True)
class _Joined:
    number: int
    second_largest: float  # m² of the second largest of those that became one here; 0 for one alone


class _Groups:
    """Which regions have become one, and how large they are."""

    def __init__(self, areas: list[float]) -> None:
        self._above = list(range(len(areas)))
        self._areas = areas

    def find(self, number: int) -> int:
        while self._above[number] != number:
            self._above[number] = self._above[self._above[number]]
            number = self._above[number]
        return number

    def join(self, numbers: set[int], more: float) -> _Joined:
        """Make these one, and so much larger; a new one where there are none."""
        if not numbers:
            self._above.append(len(self._above))
            self._areas.append(more)
            return _Joined(len(self._above) - 1, 0.0)
        largest, *others = sorted(numbers, key=lambda number: -self._areas[number])
        second = self._areas[others[0]] if others else 0.0
        for other in others:
            self._above[other] = largest
            self._areas[largest] += self._areas[other]
        self._areas[largest] += more
        return _Joined(largest, second)
