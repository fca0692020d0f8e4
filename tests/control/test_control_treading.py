"""Feet that step where ground is not a plane: as on the plane where it is level, and on treads, sills and ramps."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import PITCH, SWING, Z
from elbowroom.body.gait.gliding import gliding
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import lower_body
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from feet_walks import GAIT

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
FRAME, BALL, HEEL = 1 / 60, 6, 7  # seconds; columns of the gait's legs
BESIDE = {"type": "box", "center": [3.0, 0.1, 2.0], "size": [0.4, 0.2, 0.4]}
ASKED = (Command(forward=1.0), Command(), Command(strafe=1.0), Command(turn=1.0), Command(forward=-1.0), Command())


def shown(obstacles: list[dict[str, Any]], held: int = 45) -> Floats:
    """What is shown while commands follow on one another."""
    controller, rows = Controller(AVATAR, Scene.of("place", obstacles, finish=(0.0, 30.0))), []
    for k in range(held * len(ASKED)):
        rows.append(controller.step(ASKED[k // held], FRAME).root)
    return np.array(rows)


def test_on_a_level_floor_feet_step_and_bodies_live_as_on_the_plane() -> None:
    """A low box that nobody comes near makes the ground of a place uneven."""
    assert not Scene.of("place", [BESIDE], finish=(0.0, 30.0)).ground.plain
    assert np.abs(shown([BESIDE]) - shown([])).max() < 1e-6


@pytest.mark.parametrize("begin", [2.0, 2.08])
def test_a_foot_on_a_sill_that_is_shorter_than_itself_stands_on_its_ball(begin: float) -> None:
    """It rolls over that: in the air it would slide."""
    sill = {"type": "box", "center": [0.0, 0.05, begin + 0.05], "size": [1.8, 0.1, 0.1]}
    controller, balls = Controller(AVATAR, Scene.of("sill", [sill], finish=(0.0, 5.0))), list[float]()
    while controller.root.z < begin + 0.4:
        row = controller.step(ASKED[0], FRAME).root
        for side, (foot, rise) in enumerate(zip(row[ROOT_STATE:WITH_FEET].reshape(2, -1), row[RISES::2], strict=False)):
            if foot[SWING] <= 0.0 and row[HEIGHT] + rise > 0.08:
                balls.append(row[1] + foot[Z] + GAIT.legs[side, BALL])
    assert balls
    assert begin - 1e-3 < min(balls) <= max(balls) < begin + 0.1 + 1e-3


def test_a_foot_lands_on_a_heel_that_is_borne_behind_a_ridge() -> None:
    """Up a ramp of 12 degrees to a floor: across the ridge its heel was 15 mm in the air, and it slid about that."""
    begin, run, top = 2.0, 2.0, 2.0 * math.tan(math.radians(12.0))
    points = [[x, y, begin + z] for x in (-0.9, 0.9) for y, z in ((0.0, 0.0), (top, run), (top, run + 3.0), (0.0, 6.0))]
    scene = Scene.of("ramp", [{"type": "hull", "points": points, "center": [0.0, 0.0, 0.0]}], finish=(0.0, 8.0))
    controller, airs = Controller(AVATAR, scene), list[float]()
    while controller.root.z < begin + run + 0.5:
        row = controller.step(ASKED[0], FRAME).root
        for side, foot in enumerate(row[ROOT_STATE:WITH_FEET].reshape(2, -1)):
            rise, slope = row[RISES + 2 * side : RISES + 2 * side + 2]
            heel = GAIT.legs[side, HEEL]
            z = row[1] + foot[Z] - heel
            if foot[SWING] <= 0.0 and begin < z:
                ground = min((z - begin) / run, 1.0) * top
                airs.append(row[HEIGHT] + rise + heel * math.tan(slope) - ground)
    assert len(airs) > 50
    assert max(airs) < 0.01, max(airs)


def test_feet_of_the_cycle_are_raised_alike_in_a_row_of_their_own() -> None:
    rng, still = np.random.default_rng(0), np.zeros(WITH_FEET)
    for _ in range(200):
        root, lowering = np.zeros(ROOT_STATE), rng.uniform(0.0, 0.4, 1)
        root[3], root[6], root[RISES:] = rng.uniform(0.6, 1.3), rng.uniform(), rng.uniform(-0.2, 0.2, 4)
        both = (gliding(GAIT, still, root, 60.0), root)
        own, planned = (lower_body(GAIT, row[None], lowering) for row in both)
        assert max(np.abs(one - other).max() for one, other in zip(own, planned, strict=True)) < 0.012


def up_and_down(backwards: bool) -> list[dict[str, Any]]:
    """A ramp of 12 degrees up to a floor of 1 m, and from there a stair of 17 by 28 cm; or the other way round."""
    top, run, whole = 0.51, 0.51 / math.tan(math.radians(12.0)), 6.0

    def along(z: float) -> float:
        return whole - z if backwards else z

    points = [[x, y, along(z)] for x in (-0.9, 0.9) for y, z in ((0.0, 0.8), (0.0, 0.8 + run), (top, 0.8 + run))]
    made: list[dict[str, Any]] = [{"type": "hull", "points": points, "center": [0.0, 0.0, 0.0]}]
    for k in range(3):
        length, height = 1.0 + 0.28 * k, top - 0.17 * k
        center = [0.0, 0.5 * height, along(0.8 + run + 0.5 * length)]
        made.append({"type": "box", "center": center, "size": [1.8, height, length]})
    return made


@pytest.mark.parametrize("backwards", [False, True])
def test_feet_that_go_up_and_down_are_set_down(backwards: bool) -> None:
    """They have come down when they land: none falls the rest of its way at once."""
    controller, rows = Controller(AVATAR, Scene.of("place", up_and_down(backwards), finish=(0.0, 8.0))), list[Floats]()
    while controller.root.z < 6.0 and len(rows) < 700:
        rows.append(controller.step(ASKED[0], FRAME).root)
    assert controller.root.z >= 6.0
    falls = [
        before[HEIGHT] + before[RISES + 2 * side] - now[HEIGHT] - now[RISES + 2 * side]
        for before, now in pairwise(rows)
        for side, swing in enumerate((ROOT_STATE + SWING, ROOT_STATE + FOOT + SWING))
        if before[swing] > 0.0 >= now[swing]
    ]
    assert len(falls) >= 10
    assert max(falls) < 0.01, falls


def on_a_stair(begin: float = 2.0) -> Floats:
    """What is shown up and down a stair of four treads."""
    tread, rise, top = 0.28, 0.17, 1.2
    blocks = [
        {
            "type": "box",
            "center": [0.0, 0.5 * rise * (i + 1), begin + 4 * tread + 0.5 * top],
            "size": [1.8, rise * (i + 1), top + 2 * tread * (4 - i)],
        }
        for i in range(4)
    ]
    controller, rows = Controller(AVATAR, Scene.of("stair", blocks, finish=(0.0, 8.0))), []
    while controller.root.z < begin + 8 * tread + top:
        rows.append(controller.step(ASKED[0], FRAME).root)
    return np.array(rows)


def in_world(rows: Floats, side: int, at: int) -> Floats:
    """A place (N, 2) that the state of a foot tells of, in the world; roots face ahead."""
    first = ROOT_STATE + FOOT * side + at
    places: Floats = rows[:, :2] + rows[:, first : first + 2]
    return places


def test_a_foot_whose_heel_hangs_over_an_edge_comes_down_flat() -> None:
    """It would turn about a heel in the air, and slide."""
    begin, tread, hangs, stair = 2.0, 0.28, 0, on_a_stair()
    for side in range(2):
        feet = stair[:, ROOT_STATE + FOOT * side :][:, :FOOT]
        heights, places = stair[:, HEIGHT] + stair[:, RISES + 2 * side], in_world(stair, side, 0)[:, 1]
        for foot, height, z in zip(feet, heights, places, strict=True):
            edge = begin + tread * (round(height / 0.17) - 1)
            if foot[SWING] <= 0.0 < height and z < begin + 4 * tread and z - GAIT.legs[side, HEEL] < edge - 0.01:
                assert foot[PITCH] > -0.02
                hangs += 1
    assert hangs > 20


@pytest.mark.long
@pytest.mark.parametrize("begin", [2.0, 2.18, 2.27])
def test_who_goes_up_a_stair_stands_on_its_treads_wherever_in_a_stride_he_comes_to_it(begin: float) -> None:
    """At times a foot stood before an edge, its toes alone over the tread, with the rest of it in the air."""
    tread, stair, up = 0.28, on_a_stair(begin), 0
    edges = begin + tread * np.arange(4)
    for side in range(2):
        feet, ball = stair[:, ROOT_STATE + FOOT * side :][:, :FOOT], GAIT.legs[side, BALL]
        heights, places = stair[:, HEIGHT] + stair[:, RISES + 2 * side], in_world(stair, side, 0)[:, 1]
        for foot, height, z in zip(feet, heights, places, strict=True):
            if foot[SWING] <= 0.0 < z + ball - edges[0] and z < edges[-1]:
                assert 0.17 * np.searchsorted(edges, z + 0.6 * ball) == pytest.approx(height, abs=0.05)
                up += 1
    assert up > 60


def test_who_goes_down_a_stair_stands_on_its_treads() -> None:
    """Each foot stood on its heel over the edge of the tread above, with its ball in the air."""
    begin, tread, top, stair, down = 2.0, 0.28, 1.2, on_a_stair(), 0
    edges = begin + top + tread * np.arange(5, 9)
    for side in range(2):
        feet = stair[:, ROOT_STATE + FOOT * side :][:, :FOOT]
        heights, places = stair[:, HEIGHT] + stair[:, RISES + 2 * side], in_world(stair, side, 0)[:, 1]
        for foot, height, z in zip(feet, heights, places, strict=True):
            if foot[SWING] <= 0.0 and edges[0] < z + GAIT.legs[side, BALL] and z < edges[-1] + tread:
                under = 0.17 * (4 - np.searchsorted(edges, z + np.array([-0.05, GAIT.legs[side, BALL]])))
                assert under == pytest.approx(np.full(2, height), abs=0.01)
                down += 1
    assert down > 60
