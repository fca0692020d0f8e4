"""Planners of one's own, by name."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import elbowroom as er
from elbowroom.control.plans.canned import canned_walk
from elbowroom.planning import names, planner
from elbowroom.server.sessions.walk import WalkSettings


@pytest.fixture(autouse=True)
def restored_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(names, "_names", list(names.BUILT_IN))
    monkeypatch.setattr(planner, "PLANNERS", dict(planner.PLANNERS))


class Careless:
    """The canned walk, whatever it touches."""

    def __init__(self, humanoid: er.Humanoid, scene: er.Scene, **_: Any) -> None:
        self.plans = 0

    def reset(self) -> None:
        self.plans = 0

    def plan(self, path: er.RootPath, start: NDArray[np.float64], rng: np.random.Generator) -> er.LocalPlan:
        self.plans += 1
        return canned_walk(path, start)


def test_a_registered_planner_walks() -> None:
    er.register_planner("careless", Careless)
    controller = er.Controller(er.Humanoid.default(), er.Scene.load("empty"), planner="careless")
    for _ in range(30):
        frame = controller.step(er.Command(forward=1.0), dt=1 / 60)
    assert frame.root[1] > 0.2
    assert WalkSettings(planner="careless").planner == "careless"


def test_an_unknown_planner_is_told_all_names() -> None:
    er.register_planner("careless", Careless)
    with pytest.raises(er.InputError, match="'careful' is unknown; there are exact, figure6, careless"):
        er.Controller(er.Humanoid.default(), er.Scene.load("empty"), planner="careful")


@pytest.mark.parametrize("name", ["exact", "figure6"])
def test_the_packages_own_planners_stay(name: str) -> None:
    with pytest.raises(er.InputError, match="comes with the package"):
        er.register_planner(name, Careless)


@pytest.mark.parametrize("name", ["", "My planner", "1st", "x" * 41, "naïve", "a\n"])
def test_a_name_fits_into_a_command(name: str) -> None:
    with pytest.raises(er.InputError, match="small letters"):
        er.register_planner(name, Careless)


def test_a_name_of_ones_own_can_be_given_anew() -> None:
    er.register_planner("careless", Careless)
    er.register_planner("careless", Careless)
    assert names.planner_names() == ("exact", "figure6", "careless")
