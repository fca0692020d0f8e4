"""What carries a group's limb through the key intervals of one root path: root ways, or the waist's ways on them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_exact_kernel
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP, LimbSweeps, RootSweeps
from elbowroom.planning.exact.sweep.proof import Carrier

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]


class Carriers(NamedTuple):
    """The `Carrier` of each of n key intervals, field by field."""

    numbers: Longs  # (n,)
    places: Floats  # (n, SWEEP+1, 3)
    turns: Floats  # (n, SWEEP+1, 4)
    sway: Floats  # (n, SWEEP) metres
    states: Floats  # (n, K) the keys of the root's ways
    heights: Floats  # (n, SWEEP+1, 3) the places of these
    waists: Floats  # (n, L) the keys of the waist's ways, or once more the root's


@inner_exact_kernel
def carriers_of(roots: RootSweeps, waists: LimbSweeps, at_roots: Longs, at_waists: Longs, on_root: bool) -> Carriers:
    """What carries a limb, which is `on_root` or hangs on the waist, at these cache entries (n,) of sweeps."""
    count, own = at_roots.shape[0], roots.entries.keys if on_root else waists.entries.keys
    out = Carriers(
        np.empty(count, np.int64),
        np.empty((count, SWEEP + 1, 3)),
        np.empty((count, SWEEP + 1, 4)),
        np.empty((count, SWEEP)),
        np.empty((count, roots.entries.keys.shape[1])),
        np.empty((count, SWEEP + 1, 3)),
        np.empty((count, own.shape[1])),
    )
    for k in range(count):
        root, at = at_roots[k], at_roots[k] if on_root else at_waists[k]
        out.numbers[k] = roots.entries.ids[at] if on_root else waists.entries.ids[at]
        _copy(roots.entries.keys[root], out.states[k])
        _copy(own[at], out.waists[k])
        _copy(roots.sway[at] if on_root else waists.sway[at], out.sway[k])
        for sample in range(SWEEP + 1):
            _copy(roots.places[root, sample], out.heights[k, sample])
            _copy(roots.places[at, sample] if on_root else waists.places[at, sample], out.places[k, sample])
            _copy(roots.turns[at, sample] if on_root else waists.turns[at, sample], out.turns[k, sample])
    return out


@inner_exact_kernel
def _copy(row: Floats, out: Floats) -> None:
    for i in range(out.shape[0]):
        out[i] = row[i]


@helper
def carrier_in(carriers: Carriers, k: int) -> Carrier:
    """What carries the limb in interval k, as a proof needs it."""
    numbers, places, turns, sway, states, heights, waists = carriers
    return Carrier(numbers[k], places[k], turns[k], sway[k], states[k], heights[k], waists[k])
