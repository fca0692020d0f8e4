"""`elbowroom inspect`: what it says, as a table and as JSON, and the sheet that it draws."""

import json
import struct
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from avatar_builder import MIXAMO, Recipe, build
from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.experiment.pose_sheet.gestures import GESTURES
from elbowroom.experiment.pose_sheet.png import png_bytes
from elbowroom.experiment.pose_sheet.sheet import pose_sheet


@pytest.fixture
def figure(tmp_path: Path) -> Path:
    path = tmp_path / "figure.glb"
    path.write_bytes(build(Recipe(names=MIXAMO, prefix="mixamorig:", arms_down=0.8)))
    return path


def test_a_table_names_bones_and_how_they_were_found(figure: Path) -> None:
    result = CliRunner().invoke(app, ["inspect", str(figure)])
    assert result.exit_code == 0
    for words in ("mixamorig:LeftForeArm  (Mixamo)", "A-pose, upper arms 46", "faces", "+Z", "capsules", "stride"):
        assert words in result.output


def test_json_has_all_of_it(figure: Path) -> None:
    result = CliRunner().invoke(app, ["inspect", str(figure), "--json", "--height", "1.2"])
    facts = json.loads(result.output)["avatars"][0]
    assert facts["height"] == pytest.approx(1.2)
    assert facts["bones"]["leftHand"]["name"] == "mixamorig:LeftHand"
    assert facts["missing"] == ["jaw", "leftEye", "rightEye"]
    assert facts["coverage"]["share"] > 0.99
    assert facts["warnings"] == []
    assert facts["clips"] == []


def test_permissions_of_a_vrm_are_said(tmp_path: Path) -> None:
    (tmp_path / "a.vrm").write_bytes(build(Recipe(vrm="1", mesh=False)))
    facts = json.loads(CliRunner().invoke(app, ["inspect", str(tmp_path / "a.vrm"), "--json"]).output)["avatars"][0]
    assert facts["permissions"]["redistribution"] == "forbidden"
    assert facts["permissions"]["modification"] == "prohibited"


def test_a_folder_shows_what_can_be_read_and_says_what_cannot(figure: Path) -> None:
    (figure.parent / "broken.vrm").write_bytes(b"glTF")
    result = CliRunner().invoke(app, ["inspect", str(figure.parent), "--json"])
    assert result.exit_code == 2
    assert "broken.vrm ends after 4 bytes" in result.output
    assert "Traceback" not in result.output


@pytest.mark.parametrize("arguments", [["--height", "12"], ["--bones", "nothing.json"]])
def test_wrong_options_are_one_line(figure: Path, arguments: list[str]) -> None:
    result = CliRunner().invoke(app, ["inspect", str(figure), *arguments])
    assert result.exit_code == 2
    assert len(result.output.strip().splitlines()) == 1


def test_the_sheet_is_a_png_of_every_gesture(figure: Path, tmp_path: Path) -> None:
    out = tmp_path / "sheet.png"
    assert CliRunner().invoke(app, ["inspect", str(figure), "--capsules", "--pose-sheet", str(out)]).exit_code == 0
    data = out.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", data[16:24])
    size = struct.unpack(">I", data[33:37])[0]
    rows = np.frombuffer(zlib.decompress(data[41 : 41 + size]), np.uint8).reshape(height, 1 + 3 * width)
    assert not rows[:, 0].any()
    image = rows[:, 1:].reshape(height, width, 3)
    cells = np.split(image[16:, 96:], len(GESTURES), axis=1)
    assert all(len(np.unique(cell.reshape(-1, 3), axis=0)) > 40 for cell in cells)
    assert all(not np.array_equal(cells[0], cell) for cell in cells[1:])


def test_the_same_gesture_is_the_same_picture_whatever_the_rig(tmp_path: Path) -> None:
    """One figure in two rigs: other names, rest pose, unit and facing; their capsules are drawn in the same places."""
    bare = Recipe(names=MIXAMO, mesh=False)
    recipes = (bare, Recipe(vrm="0", heading=np.pi, mesh=False), replace(bare, arms_down=1.2, unit=100.0, spin=True))
    images = []
    for number, recipe in enumerate(recipes):
        path = tmp_path / f"{number}.glb"
        path.write_bytes(build(recipe))
        images.append(pose_sheet([Humanoid.load(path)], capsules=True)[16:, 96:].astype(int))
    for image in images[1:]:
        different = np.abs(image - images[0]).max(axis=2) > 40
        assert different.mean() < 0.01


def test_png_bytes_hold_the_picture() -> None:
    image = np.random.default_rng(0).integers(0, 256, (5, 7, 3)).astype(np.uint8)
    data = png_bytes(image)
    size = struct.unpack(">I", data[33:37])[0]
    rows = np.frombuffer(zlib.decompress(data[41 : 41 + size]), np.uint8).reshape(5, 22)
    assert np.array_equal(rows[:, 1:].reshape(5, 7, 3), image)
