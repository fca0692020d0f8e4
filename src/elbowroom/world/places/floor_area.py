"""Where the ground of a place is floor: beyond its edges nobody is led, although nothing stands there."""

import base64
import binascii
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.world.places.floors import Floor

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_MOST_SQUARES = 4_000_000
_STRIDE = 0.2  # metres: gaps that are no wider are stepped over, as at thresholds


@dataclass(frozen=True, eq=False)
class FloorArea:
    """A grid of squares over the ground."""

    origin: tuple[float, float]  # x, z of its corner, metres
    cell: float  # metres
    there: Flags  # (nx, nz)

    @classmethod
    def of(cls, floor: Floor) -> "FloorArea":
        """The area of a floor, thresholds included."""
        from scipy import ndimage  # slow to import, and not needed on a plain

        cell, around = floor.columns.cell, round(_STRIDE / floor.columns.cell) + 1
        reach = round(0.5 * _STRIDE / cell)
        disc = np.hypot(*np.mgrid[-reach : reach + 1, -reach : reach + 1]) <= reach
        closed = ndimage.binary_closing(np.pad(floor.there, around), disc)[around:-around, around:-around]
        return cls(floor.columns.origin, cell, closed)

    def packed(self) -> dict[str, Any]:
        """The area as a document has it."""
        data = base64.b64encode(zlib.compress(np.packbits(self.there).tobytes(), 6)).decode()
        return {"origin": list(self.origin), "cell": self.cell, "shape": list(self.there.shape), "data": data}

    @classmethod
    def unpacked(
        cls, origin: tuple[float, float], cell: float, shape: tuple[int, int], data: str, place: str
    ) -> "FloorArea":
        """What `packed` wrote; raises `InputError`."""
        count = shape[0] * shape[1]
        if count > _MOST_SQUARES:
            raise InputError(f"{place}.shape: has {count} squares; at most {_MOST_SQUARES} are allowed")
        size = (count + 7) // 8
        try:
            raw = zlib.decompressobj().decompress(base64.b64decode(data, validate=True), size + 1)
        except (binascii.Error, ValueError, zlib.error):
            raise InputError(f"{place}.data: is damaged: it must be as it was written") from None
        if len(raw) != size:
            raise InputError(f"{place}.data: holds {len(raw)} bytes; {count} squares need {size}")
        there = np.unpackbits(np.frombuffer(raw, np.uint8), count=count).astype(bool)
        return cls(origin, cell, there.reshape(shape))

    def holds(self, x: Floats, z: Floats) -> Flags:
        """Whether there is floor at places; any shape."""
        ix = np.floor((x - self.origin[0]) / self.cell).astype(np.int64)
        iz = np.floor((z - self.origin[1]) / self.cell).astype(np.int64)
        inside = (ix >= 0) & (ix < self.there.shape[0]) & (iz >= 0) & (iz < self.there.shape[1])
        found: Flags = inside.copy()
        found[inside] = self.there[ix[inside], iz[inside]]
        return found
