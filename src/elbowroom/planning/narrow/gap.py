"""The gap between two things that stand near to one another: where its middle is, and how one goes through it.

Whoever comes to it at a slant goes through along its axis: that is where it leaves most room for a body of some depth.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.narrow.build import Build
from elbowroom.planning.narrow.places import EVERY, MARGIN, NarrowPlaces, beside
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.world.obstacles.free_map import Window

Floats = NDArray[np.float64]

_BEHIND, _AHEAD = 0.3, 1.6  # metres along a line of travel in which a gap is looked for
_BESIDE = 0.1 * np.arange(-4.0, 5.0)  # metres to the left of the line
_SLANTS = np.deg2rad(np.arange(-45.0, 46.0, 15.0))  # from the line, at which gaps are looked through
_NEAREST = 0.15  # metres: gaps no farther beside the line than that from the nearest one
_DIRECTIONS = 36  # across which a gap is measured
_ALIKE = 0.015  # metres: gaps are as broad as that to both sides of their axis
_ROUNDS = 3  # of moving to the middle
_SLANT = math.radians(60.0)  # who comes at a greater one goes elsewhere


class Gap(NamedTuple):
    """A gap on a way."""

    x: float  # its middle
    z: float
    heading: float  # along its axis, as one comes to it


def gap_ahead(narrow: NarrowPlaces, line: TravelLine, x: float, z: float, height: float) -> Gap | None:
    """The gap nearest to a line of travel that nobody goes through with hanging arms, for who comes to (x, z) on it."""
    places = narrow.on(_looks(line, line.coordinates(x, z)[0]), height)
    places = places[places[:, 2] < narrow.build.broad + MARGIN]
    if not len(places):
        return None
    aside = np.abs(line.coordinates(places[:, 0], places[:, 1])[1])
    near = places[aside < aside.min() + _NEAREST]
    narrowest = near[near[:, 2].argmin()]
    gap_x, gap_z, across_x, across_z = _measured(
        narrow.window(narrowest[None], height), narrow.build, (narrowest[0], narrowest[1]), 2.0 * narrow.half
    )
    turned = math.remainder(math.atan2(-across_z, across_x) - line.heading, math.pi)
    return Gap(gap_x, gap_z, line.heading + turned) if abs(turned) < _SLANT else None


def _looks(line: TravelLine, ahead: float) -> Floats:
    """Places and directions (N, 4) on and beside a line from a place `ahead` on, at even steps from its first point."""
    steps = EVERY * np.arange(math.floor((ahead - _BEHIND) / EVERY), math.ceil((ahead + _AHEAD) / EVERY) + 1.0)
    along, aside, slant = (grid.ravel() for grid in np.meshgrid(steps, _BESIDE, line.heading + _SLANTS))
    return np.stack([*line.point(along, aside), np.sin(slant), np.cos(slant)], axis=1)


@exact_kernel
def _measured(
    window: Window, build: Build, place: tuple[float, float], far: float
) -> tuple[float, float, float, float]:
    """The middle of a gap, x and z, and the unit vector across it, from a place in it."""
    x, z, across_x, across_z = place[0], place[1], 1.0, 0.0
    broad = np.empty(_DIRECTIONS)
    for _ in range(_ROUNDS):
        for k in range(_DIRECTIONS):
            across_x, across_z = np.cos(np.pi * k / _DIRECTIONS), np.sin(np.pi * k / _DIRECTIONS)
            broad[k] = beside(window, build, (x, z), (across_x, across_z), far)
            broad[k] += beside(window, build, (x, z), (-across_x, -across_z), far)
        double_x, double_z = 0.0, 0.0
        for k in range(_DIRECTIONS):
            if broad[k] < broad.min() + _ALIKE:
                double_x += np.cos(2.0 * np.pi * k / _DIRECTIONS)
                double_z += np.sin(2.0 * np.pi * k / _DIRECTIONS)
        angle = 0.5 * np.arctan2(double_z, double_x)
        across_x, across_z = np.cos(angle), np.sin(angle)
        one = beside(window, build, (x, z), (across_x, across_z), far)
        other = beside(window, build, (x, z), (-across_x, -across_z), far)
        x, z = x + 0.5 * (one - other) * across_x, z + 0.5 * (one - other) * across_z
    return x, z, across_x, across_z
