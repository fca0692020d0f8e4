"""Which postures of an arm run into the avatar's own body: trunk, head and legs where they are, and the other arm.

In the chest frame the chest itself stands still, and while the waist is upright so does nearly all the rest: postures
that touch it then, at any phase of the stride, are ruled out once and for all. Where waist or other arm have left
their natural way, blocks of sixteen postures are held against each part; a block whose ball keeps away is passed over.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.kinematics import BodyModel, arm_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import exact_inner_kernel, exact_kernel
from elbowroom.planning.axis_gaps import lower_to_axis, lower_to_body
from elbowroom.planning.exact.lattice import OWN
from elbowroom.planning.exact.postures import BLOCK, Postures
from elbowroom.planning.goal import GoalFunction
from elbowroom.planning.limb import pose
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.self_pairs import SelfPairs, body_from_chest, self_pairs

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

SPARE = 0.01  # metres that a posture keeps beyond what is allowed, so that the way to the next keeps it too
_PHASES, _SPEED = 8, 1.1  # of the stride
_REMEMBERED = 4096  # surroundings of an arm

ARMS = (DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM)


class Parts(NamedTuple):
    """Capsules that an arm must keep away from, in the chest frame, and by how much."""

    axes: Floats32  # (..., P, 6)
    allowed: Floats32  # (C, P) metres


@exact_inner_kernel
def _axis_gap(axis: Floats32, x: float, y: float, z: float) -> float:
    """Distance of a point from a segment (6,)."""
    ux, uy, uz = axis[3] - axis[0], axis[4] - axis[1], axis[5] - axis[2]
    wx, wy, wz = x - axis[0], y - axis[1], z - axis[2]
    t = min(max((ux * wx + uy * wy + uz * wz) / max(ux * ux + uy * uy + uz * uz, 1e-18), 0.0), 1.0)
    return float(np.sqrt((wx - t * ux) ** 2 + (wy - t * uy) ** 2 + (wz - t * uz) ** 2))


@exact_kernel
def folded(lanes: Floats32, balls: Floats, axes: Floats32, allowed: Floats32, spare: float) -> Bools:
    """Which postures, `lanes` (B, C, 7, 16) with their `balls` (B, C, 4), come too near to the parts: shape (16 B,).

    Parts are `axes` (P, 6), `allowed` (C, P) how near the axes may come, less `spare`.
    """
    out = np.zeros((lanes.shape[0], BLOCK), np.bool_)
    gaps = np.empty(BLOCK, np.float32)
    for b in range(lanes.shape[0]):
        for c in range(lanes.shape[1]):
            x, y, z, size = balls[b, c, 0], balls[b, c, 1], balls[b, c, 2], balls[b, c, 3] - lanes[b, c, 6, 0]
            for p in range(axes.shape[0]):
                least = allowed[c, p] + spare
                if least <= 0.0 or _axis_gap(axes[p], x, y, z) > size + least:
                    continue
                gaps[:] = np.inf
                lower_to_axis(lanes[b, c], axes[p], least, gaps)
                for i in range(BLOCK):
                    out[b, i] |= gaps[i] < 0.0
    return out.reshape(lanes.shape[0] * BLOCK)


class OwnBody:
    """One avatar's body as its arms see it."""

    def __init__(self, model: BodyModel, goals: Mapping[DofGroup, GoalFunction]) -> None:
        self.model = model
        self.pairs: SelfPairs = self_pairs(model, goals)
        self._goals = goals
        self._resting: dict[tuple[int, int], tuple[Postures, Bools]] = {}
        self._prices: dict[tuple[int, int], Floats32] = {}
        self._held: dict[tuple[int, int, bytes], _Around] = {}

    def parts(self, side: int, waists: Floats, states: Floats, other: Floats | None) -> Parts:
        """What arm `side` must keep away from, at N waists (N, d), root states (N, 7), with the other arm (N, d)."""
        pairs = self.pairs
        axes = body_from_chest(self.model, pairs, waists, states).transpose(2, 0, 1)
        allowed = pairs.allowed[side]
        if other is not None:
            arm = arm_capsules(self.model, ARMS[1 - side], other).transpose(2, 0, 1)
            axes = np.concatenate([axes, arm], axis=1)
            allowed = np.concatenate([allowed, pairs.between if side == 0 else pairs.between.T], axis=1)
        return Parts(np.ascontiguousarray(axes), np.ascontiguousarray(allowed))

    def resting(self, side: int, postures: Postures) -> Bools:
        """Which postures (W,) touch the body at some phase of the natural walk, or the other arm there."""
        key = side, id(postures.configurations)
        if key not in self._resting:
            states = np.zeros((_PHASES + 1, ROOT_STATE))
            states[1:, 3], states[1:, 6] = _SPEED, np.arange(_PHASES) / _PHASES
            path = RootPath(0.0, 1.0, states)
            waists, other = self._goals[DofGroup.WAIST](path), self._goals[ARMS[1 - side]](path)
            parts = self.parts(side, waists, states, other)
            found = [folded(postures.lanes, postures.balls, axes, parts.allowed, SPARE) for axes in parts.axes]
            others = {known: kept for known, kept in self._resting.items() if known[0] != side}
            self._resting = others | {key: (postures, np.any(found, axis=0))}
            self._prices = {known: prices for known, prices in self._prices.items() if known[0] != side}
        return self._resting[key][1]

    def resting_prices(self, side: int, postures: Postures, count: int) -> Floats32:
        """What that adds to the prices (count, W + OWN) of an arm's nodes: nothing, or infinity."""
        resting = self.resting(side, postures)
        if (side, count) not in self._prices:
            prices = np.zeros((count, len(resting) + OWN), np.float32)
            prices[:, : len(resting)][:, resting] = np.inf
            self._prices[side, count] = prices
        return self._prices[side, count]

    def folded_nodes(
        self,
        side: int,
        postures: Postures,
        own: Floats,
        needed: Bools,
        natural: Bools,
        waists: Floats,
        states: Floats,
        other: Floats | None,
    ) -> Bools:
        """Which nodes of an arm are ruled out by the avatar's own body along a root path, (n+1, W + E).

        `own` (n+1, E, d) are each key time's own postures as far as they are `needed` (n+1, E), the first of them the
        goal's. Waists (n+1, d), root states
        (n+1, 7) and the other arm (n+1, d), if it is to be minded, are where `natural` (n+1,) as the goals have them.
        """
        width = len(postures.lanes) * BLOCK
        count, extra = own.shape[:2]
        out = np.zeros((count, width + extra), np.bool_)
        out[:, :width] = self.resting(side, postures)
        rows = np.flatnonzero(~natural | needed[:, 1:].any(axis=1))
        if not len(rows):
            return out
        around = self._around(side, postures, waists[rows], states[rows], None if other is None else other[rows])
        segments = pose(postures.limb, own[rows].reshape(len(rows) * extra, -1))
        held = np.stack([one.axes for one in around])
        out[rows, width:] = _own_folded(segments, held, around[0].allowed, natural[rows])
        for row, one in zip(rows, around, strict=True):
            if not natural[row]:
                out[row, :width] |= one.folded
        return out

    def _around(
        self, side: int, postures: Postures, waists: Floats, states: Floats, other: Floats | None
    ) -> list["_Around"]:
        """The body around arm `side` at N waists, root states and postures of the other arm, if it is to be minded.

        A row that was looked at for an earlier plan is known by its content.
        """
        content = np.concatenate([waists, states[:, 3:], *([] if other is None else [other])], axis=1)
        group = side, id(postures.configurations)
        names = [(*group, row.tobytes()) for row in np.round(content, 6) + 0.0]
        if len(self._held) > _REMEMBERED:
            self._held.clear()
        missing = [n for n, name in enumerate(names) if name not in self._held]
        if missing:
            parts = self.parts(side, waists[missing], states[missing], None if other is None else other[missing])
            found = _rows_folded(postures.lanes, postures.balls, parts.axes, parts.allowed)
            for n, axes, marks in zip(missing, parts.axes, found, strict=True):
                self._held[names[n]] = _Around(postures, axes, parts.allowed, marks)
        return [self._held[name] for name in names]


class _Around(NamedTuple):
    """An arm's postures among the other parts of the body, held still."""

    postures: Postures  # kept, so that no other set takes its number
    axes: Floats32  # (P, 6) as in `Parts`
    allowed: Floats32  # (C, P)
    folded: Bools  # (W,) which postures come too near


@exact_kernel
def _rows_folded(lanes: Floats32, balls: Floats, axes: Floats32, allowed: Floats32) -> Bools:
    """`folded` for parts `axes` (R, P, 6) of some rows: shape (R, 16 B)."""
    out = np.empty((axes.shape[0], lanes.shape[0] * BLOCK), np.bool_)
    for i in range(axes.shape[0]):
        out[i] = folded(lanes, balls, axes[i], allowed, SPARE)
    return out


@exact_kernel
def _own_folded(own: Floats32, axes: Floats32, allowed: Floats32, natural: Bools) -> Bools:
    """Which of each row's own postures (C, 6, R E), row after row, come too near to the parts `axes` (R, P, 6): (R, E).

    The first of a row, the goal's, does not where the others are `natural` (R,).
    """
    extra = own.shape[2] // axes.shape[0]
    out = np.empty((axes.shape[0], extra), np.bool_)
    every, gaps = np.ones(axes.shape[1], np.bool_), np.empty(extra, np.float32)
    for i in range(axes.shape[0]):
        gaps[:] = np.inf
        mine = own[:, :, i * extra : (i + 1) * extra].copy()
        lower_to_body(mine, axes[i], allowed, every, gaps)
        for e in range(extra):
            out[i, e] = gaps[e] < SPARE and not (e == 0 and natural[i])
    return out
