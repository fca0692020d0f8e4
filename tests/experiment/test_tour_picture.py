"""A tour from above shows what stands, where one went and what was visited."""

from pathlib import Path

import numpy as np
from PIL import Image
from typer.testing import CliRunner

from elbowroom.cli.main import app
from elbowroom.experiment.tour.leg import Leg
from elbowroom.experiment.tour.picture import tour_picture
from elbowroom.experiment.tour.tour import Milliseconds, TourResult
from elbowroom.planning.navigation.room_map import Rectangle, RoomMap
from elbowroom.planning.navigation.surfaces import one_plane

NONE = Milliseconds(0, 0.0, 0.0, 0.0, 0.0)
DARK = np.array([66, 70, 82])


def test_what_stands_is_dark_and_lies_where_one_who_looks_along_z_sees_it() -> None:
    room = np.full((50, 40), 0.6, np.float32)  # rows along z, columns along x
    room[40:, :10] = 0.0  # far ahead, to the right: +X points left
    leg = Leg((2.0, 1.0), "arrived", "", (2.0, 0.0, 1.0), 1.0, 1.0, 0, 0.0, 0.1)
    result = TourResult("made", 0, 1, 1, 0, 0.0, 1.0, NONE, NONE, NONE, NONE, NONE, (leg,))
    area = Rectangle(0.0, 0.0, 3.9, 4.9)
    known = RoomMap(area, one_plane((50, 40), 0.1), room.reshape(-1), room.reshape(-1), np.zeros(2000, np.float32))
    picture = tour_picture(known, 0.2, np.array([[2.0, 0.0, 0, 0, 0, 0, 0]] * 2), result)
    high, wide = picture.shape[:2]
    dark = np.argwhere((np.abs(picture.astype(int) - DARK) < 3).all(axis=2)).mean(axis=0)
    assert dark[0] < 0.3 * high
    assert dark[1] > 0.7 * wide
    marked = np.argwhere((np.abs(picture.astype(int) - (22, 130, 90)) < 3).all(axis=2)).mean(axis=0)
    assert np.abs(marked / (high, wide) - (0.8, 0.5)).max() < 0.05


def test_the_command_draws_it(tmp_path: Path) -> None:
    file = tmp_path / "tour.png"
    done = CliRunner().invoke(app, ["tour", "empty", "--targets", "1", "--no-judge", "-q", "--plan", str(file)])
    assert done.exit_code == 0, done.output
    with Image.open(file) as picture:
        assert min(picture.size) > 300
    lost = CliRunner().invoke(app, ["tour", "empty", "--targets", "1", "--no-judge", "-q", "--plan", "/nowhere/a.png"])
    assert lost.exit_code == 2
