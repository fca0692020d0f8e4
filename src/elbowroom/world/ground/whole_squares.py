"""Whether ground lies all over a square of its grid, seen at some places of it.

Surfaces that lie over one another may be as large as the square together, and leave a part of it open.
"""

from elbowroom.jit import inner_exact_kernel
from elbowroom.world.ground.ground import Ground, firm_at

_LOOKS = 4  # places across a square that are looked at


@inner_exact_kernel
def is_whole(ground: Ground, corner: tuple[float, float], height: float, below: float) -> bool:
    """Whether there is firm ground no more than `below` under a height wherever one looks in a square."""
    missing = 0
    for i in range(_LOOKS):
        for j in range(_LOOKS):
            aside, along = ground.cell * (i + 0.5) / _LOOKS, ground.cell * (j + 0.5) / _LOOKS
            missing += firm_at(ground, corner[0] + aside, corner[1] + along, height) < height - below
    return missing == 0
