"""Obstacles seen from above: where they stand, how high they are, and how far places on the ground are from them."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_exact_kernel
from elbowroom.world.obstacles.layout import HALF, ROUNDING, TURN, Nearby, Spans

Floats = NDArray[np.float64]


@inner_exact_kernel
def place_of(near: Nearby, b: int) -> tuple[float, float]:
    """Where the middle of an obstacle is, x and z."""
    return near.rows[b, 0], near.rows[b, 2]


@inner_exact_kernel
def ball_radius(near: Nearby, b: int) -> float:
    """The radius of a ball about an obstacle's middle that holds it."""
    half = near.rows[b]
    return float(np.sqrt(half[HALF] ** 2 + half[HALF + 1] ** 2 + half[HALF + 2] ** 2) + half[ROUNDING])


@inner_exact_kernel
def heights_of(near: Nearby, b: int) -> tuple[float, float]:
    """The lowest and the highest point of an obstacle, or nearly."""
    own = near.rows[b]
    up = abs(own[TURN + 1]) * own[HALF] + abs(own[TURN + 4]) * own[HALF + 1] + abs(own[TURN + 7]) * own[HALF + 2]
    return own[1] - up - own[ROUNDING], own[1] + up + own[ROUNDING]


@inner_exact_kernel
def away_of(near: Nearby, b: int, x: float, z: float) -> float:
    """Metres from a place on the ground to an upright box, seen from above; 0 inside."""
    own = near.rows[b]
    dx, dz = x - own[0], z - own[2]
    across = abs(dx * own[TURN] + dz * own[TURN + 2]) - own[HALF]
    along = abs(dx * own[TURN + 6] + dz * own[TURN + 8]) - own[HALF + 2]
    return float(np.hypot(max(across, 0.0), max(along, 0.0)))


def places_of(spans: Spans) -> Floats:
    """Where the middles of the obstacles are in each span, (n, B, 2), x and z."""
    places: Floats = spans.rows[..., [0, 2]]
    return places


def ball_radii(spans: Spans) -> Floats:
    """The radii (n, B) of balls about the obstacles' middles that hold them."""
    radii: Floats = np.linalg.norm(spans.rows[..., HALF:ROUNDING], axis=-1) + spans.rows[..., ROUNDING]
    return radii


def gaps_from_above(spans: Spans, places: Floats, height: float) -> Floats:
    """How far places (n, 2) on the ground are from upright boxes (n, B'), negative inside: those that begin lower."""
    low = (spans.rows[..., 1] - spans.rows[..., HALF + 1]).min(axis=0, initial=np.inf) < height
    rows = spans.rows[:, low]
    off, (sine, cosine) = rows[..., [0, 2]] - places[:, None], np.moveaxis(rows[..., [TURN + 6, TURN]], -1, 0)
    across = np.abs(off[..., 0] * cosine - off[..., 1] * sine) - rows[..., HALF]
    along = np.abs(off[..., 0] * sine + off[..., 1] * cosine) - rows[..., HALF + 2]
    outside = np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0))
    gaps: Floats = outside + np.minimum(np.maximum(across, along), 0.0)
    return gaps
