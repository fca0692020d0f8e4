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
