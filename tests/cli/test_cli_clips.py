"""`elbowroom clips`, and clips given to `walk`."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from animation_builder import animated_glb
from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.cli.main import app
from elbowroom.geometry import quaternion
from shared_data import SHARED, needs_shared

RUNNER = CliRunner()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A BVH, a GLB, and a file that is cut off."""
    home = tmp_path_factory.mktemp("clips")
    motion = random_motion(np.random.default_rng(0), 40, smooth=8.0)
    z_up = tuple(quaternion.about_axis(0, 0.5 * np.pi))
    bvh = write_bvh(motion, BvhRecipe(unit=0.0254, to_file=z_up, fps=50.0))
    (home / "dance.bvh").write_bytes(bvh)
    (home / "cut.bvh").write_bytes(bvh[:-300])
    (home / "moves.glb").write_bytes(animated_glb())
    return home


def test_the_table_as_json_says_what_was_recognised(folder: Path) -> None:
    result = RUNNER.invoke(app, ["clips", str(folder / "dance.bvh"), str(folder / "moves.glb"), "--json"])
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    dance, made = document["clips"]
    assert document["refused"] == {}
    assert (dance["clip"], dance["up"], dance["unit"], dance["fps"], dance["frames"]) == (
        "dance",
        "z",
        "inch",
        50.0,
        40,
    )
    assert (made["clip"], made["format"], made["up"], made["unit"], made["fps"]) == ("made", "glTF 2.0", "y", "m", 30.0)


def test_what_is_told_goes_first(folder: Path) -> None:
    told = ["--unit", "cm", "--up", "y", "--fps", "25"]
    result = RUNNER.invoke(app, ["clips", str(folder / "dance.bvh"), *told, "--json"])
    row = json.loads(result.stdout)["clips"][0]
    assert (row["unit"], row["metres_per_unit"], row["up"], row["fps"]) == ("cm", 0.01, "y", 25.0)


def test_a_refused_file_is_one_line_and_the_others_are_listed(folder: Path) -> None:
    result = RUNNER.invoke(app, ["clips", *map(str, (folder / "cut.bvh", folder / "dance.bvh")), "--list"])
    assert result.exit_code == 2
    assert "dance.bvh" in result.stdout
    (line,) = result.stderr.strip().splitlines()
    assert line.startswith("elbowroom: cut.bvh: line")


def test_one_clip_of_a_file(folder: Path) -> None:
    assert RUNNER.invoke(app, ["clips", f"{folder}/moves.glb#made", "--list"]).exit_code == 0
    result = RUNNER.invoke(app, ["clips", f"{folder}/moves.glb#other", "--list"])
    assert result.exit_code == 2
    assert "holds no clip 'other'; there are made" in result.stderr


def test_walk_refuses_a_swing_without_a_stride(folder: Path) -> None:
    result = RUNNER.invoke(app, ["walk", "--swing", str(folder / "dance.bvh")])
    assert result.exit_code == 2
    assert "nobody walks" in result.stderr


@pytest.mark.long
@needs_shared
def test_walk_with_a_recorded_swing_passes_and_replays(tmp_path: Path) -> None:
    assert SHARED is not None
    recording = tmp_path / "run.elbow"
    crouch = f"{SHARED}/motions/m2m_human-base-animations.glb#Crouch_Fwd_Loop"
    clips = ["--swing", f"{SHARED}/motions/cmu_02_02_walk.bvh", "--dodge", crouch]
    result = RUNNER.invoke(app, ["walk", "--scene", "b", *clips, "--record", str(recording), "--json"])
    assert result.exit_code == 0, result.output
    row = json.loads(result.stdout)
    assert row["straight"] is True
    assert row["least_clearance"] >= 0.0
    assert RUNNER.invoke(app, ["replay", str(recording)]).exit_code == 0
