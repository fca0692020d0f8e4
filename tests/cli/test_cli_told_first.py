"""A call that cannot be carried out is told before kernels are compiled: nobody waits for minutes to hear of a slip."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from elbowroom.cli.main import app
from elbowroom.server.kernels import kernel_cache

RUNNER = CliRunner()
RECORDING = [["verify"], ["replay"], ["export", "-o", "run.bvh"], ["film", "-o", "run.mp4"]]
WRONG = [
    ["walk", "--seed", "-1"],
    ["walk", "--limit", "0"],
    ["walk", "--limit", "nan"],
    ["walk", "--limit", "1e9"],
    ["walk", "--queue", "1"],
    ["walk", "--scene", "nothing.glb"],
    ["walk", "--scene", "nothing.json"],
    ["walk", "--scene", "gauntlet:9:1"],
    ["walk", "--avatar", "nothing.vrm"],
    ["walk", "--bones", "nothing.json"],
    ["walk", "--height", "-1"],
    ["walk", "--swing", "nothing.bvh"],
    ["walk", "--swing", "nothing.glb#walk"],
    ["walk", "--dodge", "nothing.bvh"],
    ["walk", "--fps", "0"],
    ["walk", "--unit", "mile"],
    ["walk", "--to", "here"],
    ["walk", "--vmc", "nowhere:x"],
    ["walk", "--record", "nothing/run.elbow"],
    ["walk", "--style", "zz"],
    ["walk", "--style", "old:2"],
    ["tour", "a", "--style", "zz"],
    ["tour", "nothing.glb"],
    ["tour", "a", "--targets", "0"],
    ["tour", "a", "--seed", "-1"],
    ["tour", "a", "--record", "nothing/run.elbow"],
    ["tour", "a", "--plan", "nothing/plan.png"],
    ["table1", "--seeds", "0"],
    ["table1", "--scenes", "zz"],
    ["table1", "--limit", "0"],
    ["table1", "--avatar", "nothing.vrm"],
    ["gauntlet", "--level", "9"],
    ["gauntlet", "--courses", "0"],
    ["gauntlet", "--seed", "-1"],
    ["gauntlet", "--avatar", "nothing.vrm"],
    ["gauntlet", "--place", "nothing.glb"],
    ["gauntlet", "--place", "pyproject.toml"],
    ["gauntlet", "--place", "nothing.glb", "--shapes"],
    ["gauntlet", "--drop", "Door_*"],
    ["gauntlet", "--pieces", "3"],
    ["bench", "plan", "--key-frames", "1"],
    ["bench", "plan", "--scene", "zz"],
    ["bench", "steer", "--scene", "zz"],
    ["bench", "steer", "--rounds", "0"],
    ["bench", "crowd", "--avatars", "0"],
    ["bench", "meet", "--widths", "narrow"],
    ["bench", "meet", "--widths", "0.1"],
    ["bench", "meet", "--starts", "0"],
    ["bench", "motion", "--case", "zz"],
    ["bench", "planners", "--trials", "0"],
    ["dataset", "make", "nothing.json", "--out", "made"],
    ["play", "--scene", "nothing.glb"],
    ["play", "--scene", "zz"],
    ["play", "--avatar", "nothing.vrm"],
    ["play", "--swing", "nothing.bvh"],
    ["play", "--style", "zz"],
    ["play", "--port", "-1"],
    ["play", "--planner", "zz"],
    ["serve", "--scene", "zz"],
    ["serve", "--port", "99999"],
    *([*command, "nothing.elbow"] for command in RECORDING),
]

# What is wrong with these is known to the modules that do the work, which take a second to import.
HEAVY = {
    *("--style", "--height", "--limit", "--fps", "--unit", "--rounds"),
    *("--seed", "--seeds", "--courses", "--case", "--trials", "--vmc", "bench"),
}


class CompiledError(Exception):
    """Kernels would be compiled now."""


@pytest.fixture(autouse=True)
def not_compiled(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def begun() -> bool:
        raise CompiledError

    monkeypatch.setattr(kernel_cache, "is_warm", begun)
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("arguments", WRONG, ids=" ".join)
def test_what_is_wrong_is_told_before_kernels_are_compiled(arguments: list[str]) -> None:
    result = RUNNER.invoke(app, arguments)
    assert not isinstance(result.exception, CompiledError)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr


@pytest.mark.parametrize("arguments", [["walk"], ["tour", "a"], ["table1"], ["gauntlet"], ["bench", "plan"]])
def test_a_call_that_is_right_compiles_them(arguments: list[str]) -> None:
    assert isinstance(RUNNER.invoke(app, arguments).exception, CompiledError)


def test_a_slip_is_told_before_anything_heavy_is_imported(tmp_path: Path) -> None:
    """Files that are not there, numbers out of range, and names that nothing has: within a second, so without Numba."""
    slips = [call for call in WRONG if not {*call} & HEAVY]
    code = (
        "import json, sys\n"
        "from typer.testing import CliRunner\n"
        "from elbowroom.cli.main import app\n"
        "sys.modules['numba'] = None\n"  # to import it is an error
        "calls = json.loads(sys.argv[1])\n"
        "print(json.dumps([call for call in calls if CliRunner().invoke(app, call).exit_code != 2]))\n"
    )
    command = [sys.executable, "-c", code, json.dumps(slips)]
    told = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert json.loads(told) == []
    assert len(slips) > 30
