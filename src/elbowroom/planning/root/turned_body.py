"""A body that walks along a line turned to some side: its capsules in each turn, in all of a stride."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL_GROUPS, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.root.line import TravelLine
from elbowroom.planning.root.profile import turned_speed

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_PHASES = 6  # moments of the stride in which the legs are looked at


class Turned(NamedTuple):
    """A body at the origin in several turns."""

    capsules: Floats32  # (T, C, 6) legs in every phase, trunk, arms
    slowness: Floats  # (T,) seconds for each metre


class TurnedBody:
    """Poses one humanoid; frozen once made."""

    def __init__(self, humanoid: Humanoid) -> None:
        self._model, capsules = body_model(humanoid), humanoid.capsules
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

    def along(self, line: TravelLine, angles: Floats, speeds: tuple[float, float]) -> Turned:
        """Walking along a line, turned by `angles` (T,) from its facing, at `speeds` forward and sideways, m/s."""
        turns, states = len(angles), np.zeros((len(angles), _PHASES, ROOT_STATE))
        headings = line.facing + angles
        own = np.array([turned_speed(*speeds, way) for way in line.heading - headings])
        states[:, :, 2] = headings[:, None]
        states[:, :, 3] = (own * np.cos(line.heading - headings))[:, None]
        states[:, :, 4] = (own * np.sin(line.heading - headings))[:, None]
        states[:, :, 6] = np.arange(_PHASES) / _PHASES
        flat = states.reshape(-1, ROOT_STATE)
        posed = posture_capsules(self._model, np.zeros((len(flat), DOF)), flat).reshape(-1, 6, turns, _PHASES)
        legs = np.moveaxis(posed[self._legs], (2, 3), (0, 1)).reshape(turns, -1, 6)
        rest = np.moveaxis(posed[self._rest, :, :, 0], 2, 0)
        return Turned(np.ascontiguousarray(np.concatenate([legs, rest], axis=1)), 1.0 / own)
