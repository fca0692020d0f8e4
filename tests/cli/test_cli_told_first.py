"""A call that cannot be carried out is told before anything heavy is imported: nobody waits to hear of a slip."""

import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from elbowroom.cli.main import app
from elbowroom.cli.options import arguments
from elbowroom.server.kernels import kernel_cache

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
# The same of the other options, of which `there.*` are files that hold nothing.
WRONG += [
    call.split()
    for call in (
        "bench plan --rounds 0", "bench plan --starts 0", "bench plan --scene nothing.json",
        "bench steer --seconds nan", "bench steer --seconds 0", "bench crowd --avatars many",
        "bench crowd --avatars ,", "bench crowd --seconds nan", "bench crowd --seconds 0", "bench meet --seed -1",
        "bench meet --jobs 0", "bench meet --widths nan", "bench motion --speeds fast", "bench motion --speeds 9",
        "bench motion --speeds nan", "bench motion --avatar nothing.vrm", "bench motion --height 9",
        "bench plan --plots there.elbow", "bench motion --plots there.elbow/plots", "table1 --out there.elbow",
        "gauntlet --out there.elbow/out", "dataset make there.json --out there.elbow",
        "bench planners --scene zz", "bench planners --level 9", "bench planners --limit 0", "bench planners --jobs 0",
        "bench planners --cluster x", "bench cluster --cluster x", "bench cluster --workers many",
        "bench cluster --workers 0", "bench cluster --level 9", "bench cluster --courses 0",
        "bench collision --postures 0", "bench collision --boxes 0", "bench collision --rounds 0",
        "bench collision --seed -1", "bench collision --mesh --postures 0", "bench collision --mesh --seed -1",
        "clips nothing.bvh", "clips there.elbow --unit mile", "clips there.elbow --fps 0", "clips there.elbow --up q",
        "clips there.elbow --port -1", "clips there.elbow --avatar nothing.vrm",
        "dataset make there.json --out made", "dataset make there.json --out made --walks 0",
        "dataset make there.json --out made --jobs 0", "dataset make there.json --out made --cluster x",
        "dataset check nothing", "dataset check nothing --sample -1", "dataset check nothing --jobs 0",
        "dataset check nothing --show -1", "dataset report nothing",
        "doctor --session --scene zz", "doctor --load 2 --at nonsense", "doctor --startup --scene zz",
        "export there.elbow -o run.zz", "export there.elbow -o run.bvh --fps 0",
        "export there.elbow -o run.bvh --fps nan", "export there.elbow -o run.bvh --root zz",
        "export there.elbow -o run.bvh --rest zz", "export there.elbow -o run.bvh --unit mile",
        "export there.elbow -o run.bvh --up q", "export there.elbow -o run.glb --unit cm",
        "export there.elbow -o run.vrma --root root", "export there.elbow -o run.bvh --place",
        "export there.elbow -o there.json", "export there.elbow -o nothing/run.bvh",
        "export there.elbow --scene d -o d.glb", "export -o d.glb", "export --scene d -o d.bvh",
        "export --scene zz -o d.glb",
        "film there.elbow -o run.zz", "film there.elbow -o run.png", "film there.elbow -o run.gif --camera zz",
        "film there.elbow -o run.gif --size 1x1", "film there.elbow -o run.gif --fps nan",
        "film there.elbow -o run.gif --speed nan", "film there.elbow -o run.gif --overlays zz",
        "film there.elbow -o run.gif --quality zz", "film there.elbow -o nothing/run.gif",
        "gauntlet --height nan", "gauntlet --queue 1", "gauntlet --planner zz", "gauntlet --jobs 0",
        "gauntlet --show -1", "gauntlet --save -1 course.json", "gauntlet --save 1 nothing/course.json",
        "gauntlet --place there.elbow", "gauntlet --courses 9999999", "gauntlet --bones nothing.json",
        "gauntlet --cluster x", "gauntlet --place there.glb --pieces 0",
        "inspect nothing.glb", "inspect there.elbow --as zz", "inspect there.elbow --height 9",
        "inspect there.elbow --scale 0", "inspect there.elbow --up q", "inspect there.elbow --bones nothing.json",
        "inspect there.elbow --pose-sheet nothing/sheet.png", "inspect there.elbow --plan nothing/plan.png",
        "play --height 9", "play --queue 1", "play --unit mile", "play --fps 0", "play --up q",
        "play --scale 0", "play --vmc x:y", "play --vmc-root zz", "play --style old:0.5",
        "play --scene there.glb --scale nan",
        "replay there.elbow --port -1", "replay there.elbow --avatar nothing.vrm",
        "serve --queue 1", "serve --planner zz", "serve --avatar nothing.vrm", "serve --cluster x",
        "table1 --queues x", "table1 --queues 99", "table1 --queues ,", "table1 --scenes ,", "table1 --scenes a,a",
        "table1 --planner zz", "table1 --limit nan", "table1 --jobs 0", "table1 --cluster nowhere",
        "tour a --planner zz", "tour a --queue 0", "tour a --height 9", "tour a --scale -1", "tour a --up q",
        "tour there.glb --ground nan",
        "verify there.elbow --rate 0", "verify there.elbow --rate nan", "verify there.elbow --avatar nothing.vrm",
        "walk --planner zz", "walk --height nan", "walk --scale 0", "walk --scale nan", "walk --ground nan",
        "walk --up q", "walk --fps nan", "walk --unit 0", "walk --vmc-root zz", "walk --vmc 1.2.3.4:99999",
        "walk --to 1,nan", "walk --to 1", "walk --style old:nan", "walk --scene there.glb --up q",
    )
]  # fmt: skip

HEAVY = ["numba", "scipy", "PIL", "starlette", "websockets"]  # takes long to import


TELL = """
import io, json, sys
from contextlib import redirect_stderr, redirect_stdout
from typer.main import get_command
from elbowroom.cli.main import app

heavy, calls = map(json.loads, sys.argv[1:])
sys.modules.update(dict.fromkeys(heavy))  # to import one of them is an error
command = get_command(app)
for call in calls:
    code, raised = None, ""
    with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as error:
        try:
            code = command.main(call, standalone_mode=False)
        except Exception as why:
            raised = repr(why)
    print(json.dumps([code, out.getvalue(), error.getvalue(), raised]))
"""


class CompiledError(Exception):
    """Kernels would be compiled now."""


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Any]]:
    """Of every wrong call, where nothing heavy can be imported: exit code, stdout, stderr, and what it raises."""
    folder = tmp_path_factory.mktemp("told")
    for name in ("there.elbow", "there.json", "there.glb"):
        (folder / name).touch()
    command = [sys.executable, "-c", TELL, json.dumps(HEAVY), json.dumps(WRONG)]
    lines = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout.splitlines()
    return {" ".join(call): json.loads(line) for call, line in zip(WRONG, lines, strict=True)}


@pytest.mark.parametrize("call", [" ".join(call) for call in WRONG])
def test_a_slip_is_told_in_a_line_before_anything_heavy_is_imported(call: str, told: dict[str, list[Any]]) -> None:
    """Files that are not there, numbers out of range, and names that nothing has: within a second."""
    code, out, error, raised = told[call]
    assert code == 2, raised
    assert out == ""
    assert error.count("\n") == 1, error


@pytest.mark.parametrize("call", [["walk"], ["tour", "a"], ["table1"], ["gauntlet"], ["bench", "plan"]])
def test_a_call_that_is_right_compiles_kernels(
    call: list[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def begun() -> bool:
        raise CompiledError

    monkeypatch.setattr(kernel_cache, "is_warm", begun)
    monkeypatch.chdir(tmp_path)
    assert isinstance(CliRunner().invoke(app, call).exception, CompiledError)


@pytest.mark.parametrize("call", ["tour a", "gauntlet --judge", "verify there.elbow"])
def test_who_lacks_the_judge_hears_it_before_anything_is_walked(
    call: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(arguments, "find_spec", lambda name: None if name == "coal" else find_spec(name))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.elbow").touch()
    outcome = CliRunner().invoke(app, call.split())
    assert outcome.exit_code == 2
    assert "elbowroom[judge]" in outcome.output
