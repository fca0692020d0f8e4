"""Whether the compiled clearance loop is vector code, and how wide: read from the machine code itself."""

import re
from functools import cache
from typing import Any, cast

import numba
import numpy as np

from elbowroom.world.obstacles.pairs import capsule_box

_ARITHMETIC = r"\bv(?:fm|fnm|mul|add|sub|min|max)\w*ps\b.*%"
_ENOUGH = 256  # numbers of a tile, of a row, of sixteen lanes
_BITS = {"zmm": 512, "ymm": 256, "xmm": 128}


@cache
def clearance_loop_code() -> str:
    """The assembly of the hot loop, compiled anew: what comes from the disk cache cannot be read."""
    kernel = cast(Any, capsule_box.lower_from_boxes)
    options = {key: value for key, value in kernel.targetoptions.items() if key != "nopython"}
    fresh = numba.njit(**options)(kernel.py_func)
    tile, box = np.zeros(_ENOUGH, np.float32), np.zeros(_ENOUGH, np.float32)
    fresh(tile, box, np.zeros((1, 2), np.int64), 0, np.zeros(_ENOUGH, np.float32))
    return "\n".join(fresh.inspect_asm().values())


def vector_bits() -> int:
    """The width of the vectors that most of the loop's arithmetic is done in; 0 where it is scalar or unknown."""
    code = clearance_loop_code()
    counts = {bits: len(re.findall(_ARITHMETIC + register, code)) for register, bits in _BITS.items()}
    most = max(counts, key=lambda bits: counts[bits])
    return most if counts[most] >= 60 else 0
