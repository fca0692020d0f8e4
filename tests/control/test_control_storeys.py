"""Models of places with several floors: the way from one to the other, and a walk up some steps judged by coal."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.experiment.tour.targets import random_targets
from elbowroom.experiment.tour.tour import FrameCollector, judging, run_tour
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import NoWayError
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import Scene
from place_builder import Boxes, write_place

AVATAR = Humanoid.default()
RISE, TREAD = 0.17, 0.3


def storeys(steps: int) -> Boxes:
    """A hall, and a deck beside it that so many treads lead up to along its wall."""
    top = RISE * (steps + 1)
    treads = {
        f"Tread_{i}": ((1.4, RISE * (i + 1) - 0.02, 1.0 + TREAD * (i + 0.5)), (1.2, 0.04, TREAD)) for i in range(steps)
    }
    end = 1.0 + TREAD * steps
    return {
        "Floor": ((0, -0.1, 3), (4.0, 0.2, 14.0)),
        "Deck": ((0, top - 0.1, end + 1.5), (4.0, 0.2, 3.0)),
        **treads,
    }


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    """Two storeys, 2.55 m apart."""
    return Scene.load(
        write_place(tmp_path_factory.mktemp("storeys") / "two.glb", storeys(14)), PlaceOptions(ground=0.0)
    )


def test_a_way_leads_up_the_stair_and_ends_at_its_height(two: Scene) -> None:
    navigator, goal = Navigator(AVATAR, two), (-1.0, 2.55, 6.5)
    way = navigator.find((0.0, 0.0, -2.0), goal)
    corners = way.corners((0.0, 0.0, -2.0), 1.0)
    assert way.goal == pytest.approx(goal)
    assert corners[-1] == pytest.approx(goal)
    assert any(0.8 < x < 2.0 and 0.5 < height < 2.5 for x, height, _ in corners.tolist()), "that is no stair"
    below = navigator.find((0.0, 0.0, -2.0), (-1.0, 0.0, 6.5))
    assert below.goal[1] == pytest.approx(0.0)
    assert below.left((0.0, 0.0, -2.0)) + 2.0 < way.left((0.0, 0.0, -2.0))


def test_a_place_without_a_height_is_on_the_floor_that_a_way_leads_to(two: Scene) -> None:
    navigator, spot = Navigator(AVATAR, two), (-1.0, 6.5)
    assert navigator.find((0.0, 0.0, -2.0), spot).goal[1] == pytest.approx(0.0)
    assert navigator.find((0.0, 2.55, 6.0), spot).goal[1] == pytest.approx(2.55)
    block = {"type": "box", "center": [0, 2.5 * RISE, 8], "size": [4, 5 * RISE, 4]}
    steps = [
        {"type": "box", "center": [0, 0.5 * n * RISE, 4.65 + TREAD * n], "size": [2, n * RISE, TREAD]}
        for n in range(1, 5)
    ]
    raised = Navigator(AVATAR, Scene.of("raised", [block, *steps], finish=(0.0, 12.0)))
    assert raised.find((0.0, 0.0, 0.0), (0.0, 8.0)).goal[1] == pytest.approx(5 * RISE)


def test_targets_lie_on_both_floors(two: Scene) -> None:
    heights = [height for _, height, _ in random_targets(Navigator(AVATAR, two), (0.0, -2.0), 40, 3)]
    assert min(heights) == pytest.approx(0.0)
    assert max(heights) == pytest.approx(2.55, abs=1e-3)


def test_a_place_between_the_floors_is_none_and_the_nearest_is_told(two: Scene) -> None:
    with pytest.raises(NoWayError, match="nearest place") as told:
        Navigator(AVATAR, two).find((0.0, 0.0, -2.0), (-1.0, 1.3, 6.5))
    assert told.value.nearest is not None


def test_steps_to_a_deck_are_walked_up_and_down_and_nothing_is_touched(tmp_path: Path) -> None:
    scene = Scene.load(write_place(tmp_path / "deck.glb", storeys(2)), PlaceOptions(ground=0.0))
    assert math.isinf(scene.obstacles.ground), "floors are in the way too"
    controller = Controller(AVATAR, replace(scene, start=RootState(x=1.4, z=-1.0)))
    shown = FrameCollector(controller.step(Command(), 0.0))
    result = run_tour(controller, [(1.4, 0.51, 2.8), (1.4, 0.0, 0.3)], shown.append)
    assert [leg.outcome for leg in result.legs] == ["arrived"] * 2, result.legs
    assert result.legs[0].place[1] == pytest.approx(0.51, abs=0.01)
    judgement = judging(shown, controller, mesh=False)
    assert len(list(judgement.parts())) > 1
    assert judgement.verdict().clean
