"""`elbowroom export` as a user calls it."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.clips.files import open_motion
from elbowroom.clips.retarget import retarget
from elbowroom.export.animation import Animation
from elbowroom.formats.bvh import parse_bvh
from elbowroom.geometry import quaternion
from made_recording import Made, made_recording

RUNNER = CliRunner()
AVATAR = Humanoid.default()


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    return made_recording(tmp_path_factory.mktemp("made") / "run.elbow", AVATAR)


def export(made: Made, out: Path, *options: str) -> str:
    result = RUNNER.invoke(app, ["export", str(made.recording.path), "-o", str(out), *options])
    assert result.exit_code == 0, result.output
    return result.stdout


@pytest.mark.parametrize(
    ("options", "unit"), [("", 0.01), ("--up z --unit inch --rest a", 0.0254), ("--root root --unit m", 1.0)]
)
def test_a_bvh_that_we_read_again_has_its_joints_where_they_were(
    made: Made, tmp_path: Path, options: str, unit: float
) -> None:
    export(made, tmp_path / "walk.bvh", *options.split())
    take = parse_bvh((tmp_path / "walk.bvh").read_bytes(), "walk.bvh").take()
    nodes = np.array([take.tree.names.index(bone) for bone in AVATAR.skeleton.names])
    found = take.world(nodes)[1] * unit
    if "--up z" in options:
        found = np.stack([found[..., 0], found[..., 2], -found[..., 1]], axis=-1)
    np.testing.assert_allclose(found, Animation.of(made.recording, AVATAR).joints_in_world(), atol=1e-6)


def test_a_bvh_is_recognised_as_a_clip_again(made: Made, tmp_path: Path) -> None:
    export(made, tmp_path / "walk.bvh", "--rest", "a")
    clip = open_motion(tmp_path / "walk.bvh").clip()
    assert set(clip.motion.bones) == set(AVATAR.skeleton.names)
    animation = Animation.of(made.recording, AVATAR)
    found = retarget(clip.motion, AVATAR.skeleton).rotations[:, 1:]
    # the reader straightens the rest pose, which in our avatar is bent by some degrees
    assert quaternion.angle_between(found, animation.rotations[:, 1:]).max() < np.deg2rad(5.0)


def test_an_archive_and_a_table_hold_the_joints(made: Made, tmp_path: Path) -> None:
    export(made, tmp_path / "walk.npz")
    export(made, tmp_path / "walk.csv", "--fps", "30")
    wanted = Animation.of(made.recording, AVATAR).joints_in_world()
    with np.load(tmp_path / "walk.npz") as archive:
        np.testing.assert_allclose(archive["world_positions"], wanted, atol=1e-9)
        assert tuple(archive["names"]) == AVATAR.skeleton.names
    with (tmp_path / "walk.csv").open() as file:
        rows = list(csv.DictReader(file))
    found = [[[float(row[f"{bone}.{axis}"]) for axis in "xyz"] for bone in AVATAR.skeleton.names] for row in rows]
    np.testing.assert_allclose(found, wanted[::2], atol=1e-6)


def test_what_was_written_is_told(made: Made, tmp_path: Path) -> None:
    told = json.loads(export(made, tmp_path / "walk.bvh", "--json"))
    assert told["format"] == "BVH"
    assert told["frames"] == len(made.times)
    assert told["bytes"] == (tmp_path / "walk.bvh").stat().st_size
    assert "frames" in export(made, tmp_path / "walk.bvh", "--overwrite")


def test_a_recording_that_was_cut_is_exported_as_far_as_it_goes_and_says_so(made: Made, tmp_path: Path) -> None:
    torn = tmp_path / "torn.elbow"
    torn.write_bytes(made.recording.path.read_bytes()[:-16])
    result = RUNNER.invoke(app, ["export", str(torn), "-o", str(tmp_path / "walk.bvh")])
    assert result.exit_code == 0, result.output
    assert "not whole: the file ends without its end mark" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["-o", "walk.doc"], "walk.doc: nothing is written as 'doc': choose .bvh"),
        (["-o", "walk.doc"], ".x3d, or .html for a page that plays it"),
        (["-o", "walk"], "without an ending"),
        (["-o", "walk.bvh", "--up", "x"], "up: 'x'"),
        (["-o", "walk.bvh", "--unit", "mile"], "unit: 'mile'"),
        (["-o", "walk.bvh", "--rest", "sitting"], "rest: 'sitting', allowed are t, a"),
        (["-o", "walk.bvh", "--root", "feet"], "root: 'feet', allowed are hips, root, none"),
        (["-o", "walk.bvh", "--fps", "1e9"], "fps: 1e+09"),
        (["-o", "no/such/folder/walk.bvh"], "cannot be written"),
        (["-o", "{there}"], "exists; choose another name or say --overwrite"),
    ],
)
def test_a_wrong_call_is_one_line_and_2(made: Made, tmp_path: Path, arguments: list[str], word: str) -> None:
    there = tmp_path / "there.bvh"
    there.write_text("mine")
    given = [argument.format(there=there) for argument in arguments]
    result = RUNNER.invoke(app, ["export", str(made.recording.path), *given])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1, result.stderr
    assert word in result.stderr
    assert there.read_text() == "mine"
