"""Tuples of arrays that kernels take in one piece."""

import gc
import os
import subprocess
import sys
import weakref
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.held import Held, hold
from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]


class Inner(NamedTuple):
    row: Floats
    weight: float


class Outer(NamedTuple):
    table: Floats
    inner: Inner


@exact_kernel
def raised(held: Held[Outer], by: float) -> float:
    """Raise the row in place; its weighted sum and what stands in the table."""
    outer = held.value
    for i in range(outer.inner.row.shape[0]):
        outer.inner.row[i] += by
    return float(outer.inner.weight * outer.inner.row.sum() + outer.table[0, 1])


def an_outer() -> Outer:
    rng = np.random.default_rng(0)
    return Outer(rng.standard_normal((2, 3)), Inner(rng.standard_normal(5), 0.5))


def test_a_kernel_reads_and_writes_the_arrays_themselves() -> None:
    outer = an_outer()
    held, before = hold(outer), outer.inner.row.copy()
    found = raised(held, 2.0)
    np.testing.assert_array_equal(outer.inner.row, before + 2.0)
    assert found == 0.5 * outer.inner.row.sum() + outer.table[0, 1]
    outer.table[0, 1] = 7.0
    assert raised(held, 0.0) == 0.5 * outer.inner.row.sum() + 7.0
    assert held.value is outer


def test_arrays_live_as_long_as_what_holds_them() -> None:
    outer = an_outer()
    row = weakref.ref(outer.inner.row)
    held = hold(outer)
    del outer
    gc.collect()
    assert row() is not None
    raised(held, 1.0)
    del held
    gc.collect()
    assert row() is None


def test_another_process_compiles_nothing(tmp_path: Path) -> None:
    """What takes it is found on disk, and what unpacks it too."""
    (tmp_path / "program.py").write_text(
        "import numpy as np\n"
        "from typing import NamedTuple\n"
        "from elbowroom.held import _unpacked, hold\n"
        "from elbowroom.jit import exact_kernel\n\n\n"
        "class Pair(NamedTuple):\n    row: np.ndarray\n    weight: float\n\n\n"
        "@exact_kernel\ndef weighed(pair):\n    return pair.value.weight * pair.value.row.sum()\n\n\n"
        "weighed(hold(Pair(np.ones(3), 0.5)))\n"
        "print(*(sum(kernel.stats.cache_hits.values()) for kernel in (weighed, _unpacked)))\n"
    )

    def run() -> str:
        call = [sys.executable, "-c", "import program"]
        place = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kept")}
        return subprocess.run(call, cwd=tmp_path, env=place, capture_output=True, text=True, check=True).stdout.strip()

    assert run() == "0 0"
    assert run() == "1 1"
