"""Rows known again by their content, against a dictionary."""

import numpy as np

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.memory.row_index import RowIndex, admit, forget, new_row_index, place_of


@exact_kernel
def _admitted(known: RowIndex, row: np.ndarray) -> tuple[int, int]:
    """Where a row was known, or -1, and where it is from now on."""
    return place_of(known, row), admit(known, row)


@exact_kernel
def _forgotten(known: RowIndex) -> None:
    forget(known)


def test_a_row_is_known_by_its_content_alone() -> None:
    rng, known, twin = np.random.default_rng(3), new_row_index(300, 3), dict[bytes, int]()
    for row in rng.integers(-3, 4, (2000, 3)):  # more of them than different ones, 343
        expected = twin.get(row.tobytes(), -1)
        if expected < 0 and len(twin) == 300:
            twin.clear()
        twin.setdefault(row.tobytes(), len(twin))
        assert _admitted(known, row) == (expected, twin[row.tobytes()])
        assert known.taken[0] == len(twin)
    _forgotten(known)
    assert _admitted(known, row) == (-1, 0)


def test_rows_that_differ_in_one_number_far_up_are_spread() -> None:
    """As those of an avatar that moves a single joint."""
    known = new_row_index(1024, 26)
    for value in range(1024):
        row = np.zeros(26, np.int64)
        row[0] = value << 20
        assert _admitted(known, row) == (-1, value)
    entries = np.flatnonzero(known.places >= 0)
    assert np.diff(entries).max() < 64
