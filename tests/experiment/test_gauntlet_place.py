"""Courses in places: furniture that can be moved, ways that stay free by construction, and walks along them."""

import json
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.draw import Draw
from elbowroom.experiment.gauntlet.place.course import PlaceCourseMaker
from elbowroom.experiment.gauntlet.place.furnished import MARGIN, FurnishedPlace
from elbowroom.experiment.gauntlet.place.furniture import furniture_of, made_up
from elbowroom.experiment.gauntlet.place.proof import keeps_clear, proven_walk
from elbowroom.experiment.gauntlet.place.tasks import PlaceCourses
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.reading import read_place
from elbowroom.world.places.scene_place import with_more
from elbowroom.world.scene import Scene
from place_builder import TWO_ROOMS, Boxes, write_place
from shared_data import SHARED, needs_shared

OPEN = PlaceOptions(drop=("Door_*",))
LEGS = {f"Leg_{x}_{z}": ((-1.2 + x, 0.35, 6.0 + z), (0.06, 0.7, 0.06)) for x in (-0.3, 0.3) for z in (-0.3, 0.3)}
FURNISHED: Boxes = {
    **TWO_ROOMS,
    "Desk": ((-1.2, 0.72, 6.0), (0.8, 0.04, 0.8)),
    **LEGS,
    "Lamp": ((1.0, 2.4, 6.0), (0.3, 0.2, 0.3)),  # hangs from the ceiling
}


@pytest.fixture(scope="module")
def maker(tmp_path_factory: pytest.TempPathFactory) -> PlaceCourseMaker:
    file = write_place(tmp_path_factory.mktemp("places") / "flat.glb", FURNISHED)
    return PlaceCourseMaker.open(Humanoid.default(), file, OPEN, 6)


def test_parts_that_hang_together_are_one_piece_and_the_building_none(tmp_path: Path) -> None:
    place = read_place(write_place(tmp_path / "flat.glb", FURNISHED))
    pieces, rest = furniture_of(place, 0.0)
    assert sorted(len(piece.shape.faces) // 12 for piece in pieces) == [1, 5]  # type: ignore[union-attr]
    desk = next(piece for piece in pieces if piece.height < 0.38)
    np.testing.assert_allclose(desk.half, [0.4, 0.37, 0.4], atol=1e-6)
    names = {part.name for part in rest.parts}
    assert {"Floor", "Wall_west", "Ceiling", "Door_1", "Lamp"} <= names
    assert not {"Table", "Desk", *LEGS} & names


def test_made_up_pieces_stand_on_the_floor() -> None:
    draw = Draw(1)
    for _ in range(50):
        piece = made_up(draw)
        assert piece.half[1] == pytest.approx(piece.height)
        assert (piece.half > 0.05).all()


def test_a_course_is_the_same_whenever_it_is_asked_for(maker: PlaceCourseMaker) -> None:
    first, again, other = maker.course(3), maker.course(3), maker.course(4)
    assert first.fingerprint == again.fingerprint != other.fingerprint
    assert first.pieces == again.pieces
    assert any("Table" in name for name in first.pieces) or any("Leg" in name for name in first.pieces)


@pytest.mark.parametrize("seed", range(4))
def test_the_proof_keeps_its_margin_from_all_that_stands(maker: PlaceCourseMaker, seed: int) -> None:
    course = maker.course(seed)
    walk = proven_walk(maker.humanoid, course.corners)
    standing = replace(course.scene.obstacles, ground=0.02)  # without the floor
    assert keeps_clear(walk, standing, MARGIN)
    assert not keeps_clear(walk, standing, 1.0)
    x, z = 0.5 * (course.corners[0] + course.corners[1])
    box = Obstacles((Box((0.1, 1.0, 0.1)),), np.array([[x, 0.5, z]]), np.array([[0.0, 0.0, 0.0, 1.0]]), ("in the way",))
    assert not keeps_clear(walk, with_more(standing, box), MARGIN)


def test_who_makes_courses_travels_to_other_processes(tmp_path: Path) -> None:
    file = write_place(tmp_path / "flat.glb", FURNISHED)
    made = PlaceCourses(FurnishedPlace(file, "0" * 64, OPEN), None).open()
    assert pickle.loads(pickle.dumps(made)).course(0).fingerprint == made.course(0).fingerprint


def test_pieces_are_counted() -> None:
    with pytest.raises(InputError, match="pieces: 0"):
        FurnishedPlace(Path("a.glb"), "", pieces=0)


def test_on_the_command_line_courses_are_walked_judged_and_told(tmp_path: Path) -> None:
    file = write_place(tmp_path / "flat.glb", FURNISHED)
    arguments = ["gauntlet", "--place", str(file), "--drop", "Door_*", "--courses", "1", "--jobs", "1", "--judge", "-q"]
    outcome = CliRunner().invoke(app, [*arguments, "--out", str(tmp_path / "out"), "--json"])
    assert outcome.exit_code == 0, outcome.output
    report = json.loads(outcome.stdout)
    assert report["courses"] == report["crossed"] == 1
    assert report["touching_frames"] == report["judged_touching"] == report["mesh_touching"] == 0
    assert report["settings"]["place"] == {"file": "flat.glb", "pieces": 8, "margin": MARGIN}
    assert json.loads((tmp_path / "out" / "gauntlet-place.json").read_text()) == report
    again = CliRunner().invoke(app, [*arguments, "--out", str(tmp_path / "out")])
    assert "flat.glb with 8 pieces of furniture" in again.stdout
    assert CliRunner().invoke(app, [*arguments, "--shapes"]).exit_code == 2


def test_a_course_is_a_scene_that_stands_for_itself(maker: PlaceCourseMaker, tmp_path: Path) -> None:
    file = write_place(tmp_path / "flat.glb", FURNISHED)
    arguments = ["gauntlet", "--place", str(file), "--drop", "Door_*", "--pieces", "6", "--seed", "2", "-q", "--save"]
    outcome = CliRunner().invoke(app, [*arguments, "1", str(tmp_path / "course.json")])
    assert outcome.exit_code == 0, outcome.output
    file.unlink()
    saved, wanted = Scene.load(tmp_path / "course.json"), maker.course(3).scene
    assert saved.to_dict() == wanted.to_dict()
    assert saved.obstacles.names == wanted.obstacles.names


@pytest.mark.long
@needs_shared
def test_a_house_is_walked_through_between_its_furniture() -> None:
    file = Path(f"{SHARED}/scenes/AC14-FZK-Haus/AC14-FZK-Haus.glb")
    made = PlaceCourseMaker.open(Humanoid.default(), file, PlaceOptions(drop=("IfcDoor_*",)), 5)
    assert len(made.own) == 5
    assert any("IfcFurnishingElement" in name for name in made.course(1).pieces)
