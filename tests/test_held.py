"""Tuples of arrays that kernels take in one piece."""

import gc
import os
import subprocess
import sys
import weakref
from pathlib import Path

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import BodyModel, body_model
from elbowroom.held import Held, hold
from elbowroom.jit import exact_kernel


@exact_kernel
def raised(held: Held[BodyModel], by: float) -> float:
    """Raise the offsets in place; their sum in units of half a leg."""
    model = held.value
    model.offsets[:] += by
    return float(model.offsets.sum() / model.gait.half_leg)


def a_model() -> BodyModel:
    model = body_model(Humanoid.default())
    return model._replace(offsets=model.offsets.copy())


def test_a_kernel_reads_and_writes_the_arrays_themselves() -> None:
    model = a_model()
    held, before = hold(model), model.offsets.copy()
    found = raised(held, 2.0)
    np.testing.assert_array_equal(model.offsets, before + 2.0)
    assert np.isclose(found, model.offsets.sum() / model.gait.half_leg, rtol=1e-12)
    model.offsets[:] = 1.0
    assert raised(held, 0.0) == model.offsets.size / model.gait.half_leg
    assert held.value is model


def test_arrays_live_as_long_as_what_holds_them() -> None:
    model = a_model()
    offsets = weakref.ref(model.offsets)
    held = hold(model)
    del model
    gc.collect()
    assert offsets() is not None
    raised(held, 1.0)
    del held
    gc.collect()
    assert offsets() is None


PROGRAM = """
from typing import NamedTuple
import numpy as np
from elbowroom.held import _unpacking, hold
from elbowroom.jit import exact_kernel


class Pair(NamedTuple):
    row: np.ndarray
    weight: float


class Outer(NamedTuple):
    pair: Pair


@exact_kernel
def weighed(outer):
    pair = outer.value.pair
    return pair.weight * pair.row.sum()


weighed(hold(Outer(Pair(np.ones(3), 0.5))))
print(*(sum(kernel.stats.cache_hits.values()) for kernel in (weighed, _unpacking(Outer))))
"""


def test_another_process_compiles_nothing_until_a_type_is_another(tmp_path: Path) -> None:
    """What unpacks a tuple is found on disk as the kernels that take it are; not where its types have changed."""

    def run(program: str) -> str:
        (tmp_path / "program.py").write_text(program)
        call = [sys.executable, "-c", "import program"]
        place = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kept"), "PYTHONDONTWRITEBYTECODE": "1"}
        return subprocess.run(call, cwd=tmp_path, env=place, capture_output=True, text=True, check=True).stdout.strip()

    assert run(PROGRAM) == "0 0"
    assert run(PROGRAM) == "1 1"
    assert run(PROGRAM.replace("Pair", "Couple")) == "0 0"
