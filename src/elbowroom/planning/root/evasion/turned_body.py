"""A body that walks turned to some side: its capsules in each turn, in all of a stride, and upright discs for them.

The discs stand for the capsules on the map of free distances: points along each capsule's axis, each at the map's
nearest level. They are a little smaller than the capsules. Seen from the line's facing they are the same for every
line, so they are made once for each direction that a body goes in its own axes.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL_GROUPS, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import exact_kernel
from elbowroom.planning.root.evasion.profile import turned_speed
from elbowroom.world.obstacles.free_map import LEVELS

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_PHASES = 6  # moments of the stride in which the legs are posed
_SPACING = 0.15  # metres between points on a capsule's axis, at most
_COVERED = 0.015  # metres: a disc that stands out of another by no more than this is left out
_MOST = 16  # directions that are remembered


class Discs(NamedTuple):
    """Upright discs, those of a turn and a group one after the other."""

    places: Floats  # (K, 2) metres to the left and ahead of the root, of who faces along the line's facing
    radii: Floats  # (K,)
    levels: Indices  # (K,) of the map
    starts: Indices  # (T, 4) where those of legs, trunk and arms begin, and where the turn's end
    reach: float  # metres from the root that no disc exceeds


class Turned(NamedTuple):
    """A body at the origin in several turns."""

    capsules: Floats32  # (T, C, 6) legs in every phase, trunk, arms
    slowness: Floats  # (T,) seconds for each metre
    discs: Discs


class TurnedBody:
    """Poses one humanoid; what it remembers is what it would make again."""

    def __init__(self, humanoid: Humanoid, angles: Floats) -> None:
        """It is posed turned by `angles` (T,) to the left of where it means to face."""
        self._model, self._angles, capsules = body_model(humanoid), angles, humanoid.capsules
        legs = capsules.of(DofGroup.ROOT)
        trunk, arms = (
            np.concatenate([capsules.of(group) for group in LOCAL_GROUPS if group.is_arm is is_arm])
            for is_arm in (False, True)
        )
        self._legs, self._rest = legs, np.concatenate([trunk, arms])
        counts = [_PHASES * len(legs), len(trunk), len(arms)]
        self.groups: Indices = np.concatenate([[0], np.cumsum(counts)])  # where legs, trunk, arms begin; the end
        radii = capsules.radii.astype(np.float32)
        self.radii: Floats32 = np.concatenate([np.tile(radii[legs], _PHASES), radii[trunk], radii[arms]])
        self._known: dict[tuple[float, float, float], Turned] = {}

    def going(self, direction: float, speeds: tuple[float, float]) -> Turned:
        """Who means to face ahead goes `direction` radians to the left of that, at `speeds` forward and sideways."""
        asked = round(direction, 6), *speeds
        if asked not in self._known:
            if len(self._known) >= _MOST:
                self._known.clear()
            self._known[asked] = self._posed(*asked)
        return self._known[asked]

    def _posed(self, direction: float, forward: float, sideways: float) -> Turned:
        angles = self._angles
        turns, states = len(angles), np.zeros((len(angles), _PHASES, ROOT_STATE))
        own = np.array([turned_speed(forward, sideways, direction - angle) for angle in angles])
        states[:, :, 2] = angles[:, None]
        states[:, :, 3] = (own * np.cos(direction - angles))[:, None]
        states[:, :, 4] = (own * np.sin(direction - angles))[:, None]
        states[:, :, 6] = np.arange(_PHASES) / _PHASES
        flat = states.reshape(-1, ROOT_STATE)
        posed = posture_capsules(self._model, np.zeros((len(flat), DOF)), flat).reshape(-1, 6, turns, _PHASES)
        legs = np.moveaxis(posed[self._legs], (2, 3), (0, 1)).reshape(turns, -1, 6)
        rest = np.moveaxis(posed[self._rest, :, :, 0], 2, 0)
        capsules = np.ascontiguousarray(np.concatenate([legs, rest], axis=1))
        order = np.concatenate([np.argsort(-self.radii[a:b], kind="stable") + a for a, b in self._parts()])
        return Turned(
            capsules, 1.0 / own, _outermost_first(_discs_of(capsules, self.radii, self.groups, order, LEVELS))
        )

    def _parts(self) -> list[tuple[int, int]]:
        return list(zip(self.groups[:-1].tolist(), self.groups[1:].tolist(), strict=True))


def _outermost_first(discs: Discs) -> Discs:
    """The same, those of a turn and a group by how far they reach: a cell that is closed is soon known to be."""
    reaches = np.hypot(*discs.places.T) + discs.radii
    bounds = [*discs.starts[:, :3].ravel().tolist(), len(reaches)]
    order = np.concatenate([a + np.argsort(-reaches[a:b], kind="stable") for a, b in pairwise(bounds)])
    return discs._replace(places=discs.places[order], radii=discs.radii[order], levels=discs.levels[order])


@exact_kernel
def _discs_of(capsules: Floats32, radii: Floats32, groups: Indices, order: Indices, heights: Floats) -> Discs:
    """The discs of capsules (T, C, 6), taken in an `order` (C,) within their groups; heights (L,) of the levels."""
    most, turns = 0, capsules.shape[0]
    for t in range(turns):
        for c in range(capsules.shape[1]):
            most += 2 + int(_length(capsules[t, c]) / _SPACING)
    places, sizes, levels = np.empty((most, 2)), np.empty(most), np.empty(most, np.int64)
    starts, count, reach, step = np.empty((turns, 4), np.int64), 0, 0.0, heights[1] - heights[0]
    for t in range(turns):
        for g in range(3):
            starts[t, g] = begin = count
            for at in range(groups[g], groups[g + 1]):
                capsule, radius = capsules[t, order[at]], radii[order[at]]
                pieces = 1 + int(_length(capsule) / _SPACING)
                for n in range(pieces + 1):
                    u = n / pieces
                    x, z = capsule[0] + u * (capsule[3] - capsule[0]), capsule[2] + u * (capsule[5] - capsule[2])
                    height = capsule[1] + u * (capsule[4] - capsule[1])
                    level = min(max(int(np.rint((height - heights[0]) / step)), 0), heights.shape[0] - 1)
                    covered = False
                    for k in range(begin, count):
                        away = np.hypot(x - places[k, 0], z - places[k, 1])
                        covered = covered or (levels[k] == level and away + radius <= sizes[k] + _COVERED)
                    if not covered:
                        places[count, 0], places[count, 1], sizes[count], levels[count] = x, z, radius, level
                        reach = max(reach, np.hypot(x, z) + radius)
                        count += 1
        starts[t, 3] = count
    return Discs(places[:count].copy(), sizes[:count].copy(), levels[:count].copy(), starts, reach)


@exact_kernel
def _length(capsule: Floats32) -> float:
    """Metres from one end of the axis to the other."""
    dx, dy, dz = capsule[3] - capsule[0], capsule[4] - capsule[1], capsule[5] - capsule[2]
    return float(np.sqrt(dx * dx + dy * dy + dz * dz))
