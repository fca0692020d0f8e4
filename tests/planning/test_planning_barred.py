"""Where the waist has no path left nothing is searched twice, and postures that are added are such as legs can do."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOWERING, DofGroup
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

HUMANOID = proportional_humanoid(1.72)
STEP = 0.15  # seconds between key frames
COLUMN = LOWERING - DofGroup.WAIST.at.start
BEAM = ((0.0, 1.45, 1.35), (1.5, 0.45, 0.06))  # centre and half size: its lower edge is at 1.0 m
CUPBOARD = ((0.0, 1.5, 1.6), (3.0, 0.5, 0.4))  # from 1 m up
RAILS = tuple(((side * 0.22, 0.5, 1.2), (0.03, 0.05, 1.2)) for side in (-1.0, 1.0))  # beside the thighs, 38 cm apart


def scene_of(*boxes: tuple[tuple[float, ...], tuple[float, ...]]) -> Scene:
    centers, halves = (np.array(each) for each in zip(*boxes, strict=True))
    obstacles = Obstacles.boxes(centers, np.tile([0.0, 0.0, 0.0, 1.0], (len(boxes), 1)), halves)
    names = tuple(f"box {number}" for number in range(len(boxes)))
    return replace(Scene.load("empty"), obstacles=replace(obstacles, standing_names=names))


def walk(horizon: int = 16, speed: float = 0.9) -> RootPath:
    states, time = np.zeros((horizon + 1, ROOT_STATE)), STEP * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = speed * time, speed, 0.8 * time
    return RootPath(0.0, STEP, states)


def planned(body: UpperBodyPlanner, effort: Effort) -> UpperPlan:
    start = natural_walk()(walk(speed=0.0))[0]
    return body.plan(walk(), StartState(start, np.zeros(LOCAL)), effort=effort)


def test_all_groups_together_find_no_more_where_the_waist_is_barred() -> None:
    quick, joint = (
        planned(UpperBodyPlanner(HUMANOID, scene_of(BEAM), ExactSettings()), effort)
        for effort in (Effort.QUICK, Effort.JOINT)
    )
    assert quick.search.barred
    assert quick.reached == joint.reached < walk().horizon
    assert joint.plan.joint is None


def test_who_walks_towards_what_bars_the_waist_searches_no_path_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    plan, barred, again = UpperBodyPlanner.plan, set[bytes](), list[Effort]()

    def seen(body: UpperBodyPlanner, path: RootPath, *told: Any) -> UpperPlan:
        effort, name = told[3], path.states.tobytes() + np.float64(path.start_time).tobytes()
        if effort is Effort.JOINT and name in barred:
            again.append(effort)
        found = plan(body, path, *told)
        if found.search.barred:
            barred.add(name)
        return found

    monkeypatch.setattr(UpperBodyPlanner, "plan", seen)
    controller = Controller(HUMANOID, scene_of(CUPBOARD))
    for _ in range(180):
        controller.step(Command(forward=1.0), 1 / 60)
    assert controller.stands
    assert len(barred) > 1
    assert not again


def test_postures_that_are_added_are_such_as_legs_can_do() -> None:
    """Under a beam, between rails that bent knees do not fit between: there one bends, and crouches no deeper."""
    made = scene_of(((0.0, 1.6, 1.35), (1.5, 0.1, 0.06)), *RAILS)
    body = UpperBodyPlanner(HUMANOID, made, ExactSettings(samples_share=0.1))
    known, search = len(body.memory.known(DofGroup.WAIST)), planned(body, Effort.JOINT).search
    assert search.blocked[1] < walk().horizon
    assert body._refine(search)
    added = body.memory.known(DofGroup.WAIST)[known:]
    slices = walk().states[search.blocked[1] :][: body._refinement.slices]
    clear = [search.legs.clearances(np.tile(root, (len(added), 1)), added[:, COLUMN]) for root in slices]
    assert len(added) > 20
    assert np.max(clear, axis=0).min() > 0.0
    assert planned(body, Effort.REFINED).reached == walk().horizon


def test_a_search_that_is_gone_on_with_is_where_it_was_after_others() -> None:
    body = UpperBodyPlanner(HUMANOID, scene_of(BEAM), ExactSettings(samples_share=0.1))
    search = planned(body, Effort.JOINT).search
    before, begins = search.blocked_slice(), search.problem.begins
    for number in range(8):
        aside = walk()
        aside.states[:, 0] += 0.05 * (number + 1)
        body.plan(aside, begins, effort=Effort.GLANCE)
    assert not np.array_equal(search.blocked_slice().around.places, before.around.places)
    body.plan(walk(), begins, effort=Effort.REFINED, after=search)
    again = search.blocked_slice()
    np.testing.assert_array_equal(again.around.places, before.around.places)
    np.testing.assert_array_equal(again.waists, before.waists)
