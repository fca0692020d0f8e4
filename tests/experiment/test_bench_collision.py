"""The collision benchmark: honest inputs, rivals that agree, and figures that are there."""

import json
import re
from importlib.util import find_spec

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.cli.main import app
from elbowroom.errors import InputError
from elbowroom.experiment.bench.capsule_inputs import capsule_inputs
from elbowroom.experiment.bench.rivals import rivals
from elbowroom.experiment.bench.settings import CollisionSettings
from elbowroom.experiment.bench.vector_code import clearance_loop_code, vector_bits
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import clearance


def test_placements_are_the_capsules() -> None:
    inputs = capsule_inputs(50, 4, 3)
    middles, turns = inputs.placements()
    axes = quaternion.rotate(turns, np.array([0.0, 0.0, 1.0])) * 0.5 * inputs.lengths[:, None]
    ends = np.moveaxis(inputs.segments, 2, 0)
    np.testing.assert_allclose(np.concatenate([middles - axes, middles + axes], axis=-1), ends, atol=1e-6)
    assert inputs.checks == 3 * 4 * 50


def test_every_rival_gives_our_answer_wherever_it_is_not_close() -> None:
    inputs = capsule_inputs(400, 6, 11)
    clear = clearance(inputs.segments, inputs.radii, inputs.boxes.standing)
    assert 0.02 < np.mean(clear < 0.0) < 0.9
    found, _ = rivals(inputs)
    assert any(rival.name.startswith("coal") for rival in found)
    for rival in found:
        differs = (rival.touching() != (clear < 0.0)) & (np.abs(clear) > 1e-6)
        assert not differs.any(), rival.name


def test_the_hot_loop_is_vector_code_as_wide_as_the_processor_has() -> None:
    from llvmlite.binding import get_host_cpu_features

    features = get_host_cpu_features()
    if not re.search(r"\bv?addss\b|\bv\w+ps\b", clearance_loop_code()) or not features.get("avx2"):
        pytest.skip("vector registers are counted on x86 processors with AVX2 only")
    expected = 512 if features.get("avx512f") else 256
    assert vector_bits() == expected, "the clearance loop lost its vector code: expect a fraction of the speed"


@pytest.mark.long
def test_command_prints_every_figure() -> None:
    result = CliRunner().invoke(
        app, ["bench", "collision", "--postures", "64", "--rounds", "1", "--json"], standalone_mode=False
    )
    found = json.loads(result.stdout)
    assert found["own"]["checks_per_second"] > 0
    assert {"machine", "seed", "vector_bits", "rivals", "missing", "touching_share"} <= set(found)
    installed = [module for module in ("coal", "mujoco", "pinocchio") if find_spec(module)]
    assert len(found["rivals"]) == len(installed)
    assert all(rival["disagreements"] == 0 and rival["ratio"] > 0 for rival in found["rivals"])


@pytest.mark.parametrize(("field", "value"), [("postures", 0), ("boxes", 1001), ("rounds", 0)])
def test_sizes_out_of_range_are_refused(field: str, value: int) -> None:
    with pytest.raises(InputError, match=field):
        CollisionSettings(**{field: value})
