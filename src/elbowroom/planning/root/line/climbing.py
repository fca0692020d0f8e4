"""Slower where ground rises or falls more steeply than an even stair: on spirals, the steeper the slower, and in time.

So a foot comes down on the next tread, not on one beyond it, and the pace is found at once for which legs are free.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.root.line.route import route_points
from elbowroom.planning.root.motion import NONE_SLOW
from elbowroom.world.ground.ground import Ground, heights_along

Floats = NDArray[np.float64]

_EVERY, _ABOUT = 0.12, 3  # metres between places of a route that are looked at; of these before and behind each
_CLIMB = 0.24  # m/s up or down
_STEEP = 0.8  # metres up or down in a metre, of treads that are counted whole: no even stair has so many


def steep_places(ground: Ground, route: Floats, height: float, speed: float) -> Floats:
    """Places (K, 3), x, z and the share of the wanted `speed`, on a route (m, 2); a body is at its first at a `height`.

    No kerb, sill or even stair slows anybody down.
    """
    if ground.plain or speed <= 0.0:
        return NONE_SLOW
    points, _ = route_points(route, _EVERY)
    heights = heights_along(ground, height, points)
    points, heights = points[np.isfinite(heights)], heights[np.isfinite(heights)]
    if len(points) <= 2 * _ABOUT or np.ptp(heights) <= ground.step:
        return NONE_SLOW
    about = np.pad(heights, _ABOUT, mode="edge")
    steep = np.abs(about[2 * _ABOUT :] - about[: -2 * _ABOUT]) / (2 * _ABOUT * _EVERY)
    share = np.minimum(_CLIMB / (speed * np.maximum(steep, _STEEP)), 1.0)
    places: Floats = np.column_stack([points, share])[steep > _STEEP]
    return places
