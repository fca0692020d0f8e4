"""Rows of whole numbers known again by their content: each has a place of its own, where results about it are kept."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel

Longs = NDArray[np.int64]

_EMPTY = -1
_SEED, _FACTOR = np.uint64(0xCBF29CE484222325), np.uint64(0x100000001B3)  # of the hash FNV-1a, here of whole numbers
_HIGH = np.uint64(40)  # its best mixed bits are those from this one on


@by_reference
class RowIndex(NamedTuple):
    """Which rows are known, and where."""

    rows: Longs  # (S, K) by their places
    places: Longs  # (H,) by the hash of a row, or in the next entry that was empty; H is a power of two, at least 2 S
    taken: Longs  # (1,) how many places are taken: the first ones


def new_row_index(count: int, width: int) -> RowIndex:
    """Room for so many rows (K,) of `width` numbers, none of which is known."""
    places = np.full(2 << (count - 1).bit_length(), _EMPTY)
    return RowIndex(np.empty((count, width), np.int64), places, np.zeros(1, np.int64))


@exact_kernel
def forget(known: RowIndex) -> None:
    """From now on no row is known."""
    known.taken[0] = 0
    for entry in range(known.places.shape[0]):
        known.places[entry] = _EMPTY


@inner_exact_kernel
def place_of(known: RowIndex, row: Longs) -> int:
    """The place of a row (K,), or -1 if it is not known."""
    return int(known.places[_entry_of(known, row)])


@inner_exact_kernel
def admit(known: RowIndex, row: Longs) -> int:
    """The place of a row (K,), a new one if it was not known; where all are taken, all others are forgotten."""
    entry = _entry_of(known, row)
    if known.places[entry] < 0:
        if known.taken[0] == known.rows.shape[0]:
            forget(known)
            entry = _entry_of(known, row)
        place = known.taken[0]
        known.taken[0] = place + 1
        known.places[entry] = place
        for i in range(row.shape[0]):
            known.rows[place, i] = row[i]
    return int(known.places[entry])


@inner_exact_kernel
def _entry_of(known: RowIndex, row: Longs) -> int:
    """Where among `places` that of a row is, or would be."""
    mixed = _SEED
    for i in range(row.shape[0]):
        mixed = (mixed ^ np.uint64(row[i])) * _FACTOR
    last = known.places.shape[0] - 1
    entry = np.int64(mixed >> _HIGH) & last
    while known.places[entry] >= 0 and not _same(known.rows[known.places[entry]], row):
        entry = (entry + 1) & last
    return int(entry)


@helper
def _same(one: Longs, other: Longs) -> bool:
    different = 0
    for i in range(one.shape[0]):
        different |= one[i] ^ other[i]
    return different == 0
