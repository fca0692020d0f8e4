"""`elbowroom inspect`: what it says, as a table and as JSON, and the sheet that it draws."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from avatar_builder import MIXAMO, Recipe, build
from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.experiment.pose_sheet.gestures import GESTURES
from elbowroom.experiment.pose_sheet.lettering import Lettering
from elbowroom.experiment.pose_sheet.sheet import SIDE, TALL, TOP, WIDE, pose_sheet
from odd_bodies import box_body
from place_builder import write_place


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


def test_the_sheet_is_a_png_of_every_gesture_and_says_where_it_went(figure: Path, tmp_path: Path) -> None:
    out = tmp_path / "sheet.png"
    result = CliRunner().invoke(app, ["inspect", str(figure), "--capsules", "--pose-sheet", str(out), "-q"])
    assert result.exit_code == 0
    image = np.asarray(Image.open(out).convert("RGB"))
    height, width, _ = image.shape
    assert (height, width) == (TOP + TALL, SIDE + 8 * WIDE)
    assert result.stdout == f"{out}: figure in eight gestures, {width} x {height} pixels\n"
    cells = np.split(image[TOP:, SIDE:], len(GESTURES), axis=1)
    assert all(len(np.unique(cell.reshape(-1, 3), axis=0)) > 40 for cell in cells)
    assert all(not np.array_equal(cells[0], cell) for cell in cells[1:])
    drawn = np.abs(cells[2].astype(int) - cells[2][0, 0]).max(axis=2) > 40  # a figure that hangs its arms
    rows = np.flatnonzero(drawn.any(axis=1))
    assert rows[-1] - rows[0] > 0.6 * TALL
    for column in range(8):  # a word above each
        head = image[:TOP, SIDE + column * WIDE : SIDE + (column + 1) * WIDE]
        assert (head.min(axis=2) < 120).sum() > 20
    assert (image[TOP:, :SIDE].min(axis=2) < 120).sum() > 200  # the name


def test_a_sheet_that_cannot_be_written_is_one_line(figure: Path, tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["inspect", str(figure), "-q", "--pose-sheet", str(tmp_path / "no" / "sheet.png")])
    assert result.exit_code == 2
    assert "cannot be written" in result.output


@pytest.mark.parametrize("name", ["a", "KoreanCharacter02Chul", "VRMC_materials_mtoon_UV_Animation_Test", "x" * 300])
def test_names_are_broken_where_they_may(name: str) -> None:
    paper = np.full((200, 200, 3), 255, np.uint8)
    lettering = Lettering(paper)
    below = lettering.wrapped(name, 10, 10, 150, 20, (0, 0, 0))
    ink = np.argwhere(lettering.image().min(axis=2) < 128)
    assert 10 < below <= 10 + 4 * 25
    assert ink[:, 0].max() < below
    assert ink[:, 1].max() <= 161
    assert (paper == 255).all()


def test_the_same_gesture_is_the_same_picture_whatever_the_rig(tmp_path: Path) -> None:
    """One figure in two rigs: other names, rest pose, unit and facing; their capsules are drawn in the same places."""
    bare = Recipe(names=MIXAMO, mesh=False)
    recipes = (bare, Recipe(vrm="0", heading=np.pi, mesh=False), replace(bare, arms_down=1.2, unit=100.0, spin=True))
    images = []
    for number, recipe in enumerate(recipes):
        path = tmp_path / f"{number}.glb"
        path.write_bytes(build(recipe))
        images.append(pose_sheet([Humanoid.load(path)], capsules=True)[TOP:, SIDE:].astype(int))
    for image in images[1:]:
        different = np.abs(image - images[0]).max(axis=2) > 40
        assert different.mean() < 0.01


def test_a_bone_without_mesh_is_not_said_to_be_covered(tmp_path: Path) -> None:
    """The boxes leave abdomen and neck bare."""
    path = tmp_path / "boxes.vrm"
    path.write_bytes(build(Recipe(vrm="1", body=box_body())))
    output = CliRunner().invoke(app, ["inspect", str(path)]).output
    (note,) = [line for line in output.splitlines() if line.startswith("note: without mesh")]
    bare = note.partition("average proportions: ")[2].split(", ")
    assert "neck" in bare
    rows = {line.split()[0]: line for line in output.splitlines() if " cm" in line and line.strip()}
    assert all("covers" not in rows[part] for part in bare)
    assert "covers" in rows["head"]
    token = tmp_path / "token.vrm"
    token.write_bytes(build(Recipe(vrm="1", mesh=False)))
    output = CliRunner().invoke(app, ["inspect", str(token)]).output
    assert "of average proportions" in output
    assert "covers" not in output
    assert "100.0%" not in output


def test_a_place_is_looked_over_and_drawn(tmp_path: Path) -> None:
    file = write_place(tmp_path / "rooms.glb")
    plan = tmp_path / "plan.png"
    call = ["inspect", str(file), "--drop", "Door_*", "--drop", "Window_*", "--plan", str(plan), "--json"]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 0
    (facts,) = json.loads(result.stdout)["places"]
    assert facts["left_out"] == ["Door_1"]
    assert facts["notes"][0] == "drop 'Window_*' matches no name in the file"
    assert facts["floors"][0]["passages"][0]["width"] == pytest.approx(0.8, abs=0.1)
    with Image.open(plan) as drawn:
        assert drawn.size[0] > 400
    told = CliRunner().invoke(app, ["inspect", str(file)]).output
    assert "narrowest passages" in told


def test_a_place_may_be_called_one(tmp_path: Path) -> None:
    file = tmp_path / "a.vrm"
    write_place(tmp_path / "a.glb").rename(file)
    assert CliRunner().invoke(app, ["inspect", str(file), "--as", "place"]).exit_code == 0
    assert CliRunner().invoke(app, ["inspect", str(file), "--as", "avatar"]).exit_code == 2
    assert CliRunner().invoke(app, ["inspect", str(file), "--as", "thing"]).exit_code == 2
