"""What has walked is gone as soon as nobody holds it: not only when garbage is looked for, which servers seldom do."""

import gc
from collections import Counter

import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.planning.names import EXACT, FIGURE6
from elbowroom.world.scene import Scene
from sampled import sampled


@pytest.mark.parametrize(("planner", "scene"), sampled([(EXACT, "d"), (FIGURE6, "a")]))
def test_nothing_is_left_of_a_walk_and_its_scene(planner: str, scene: str) -> None:
    _walk(planner, scene)  # what is made once and stays
    gc.collect()
    gc.disable()
    try:
        before = _ours()
        _walk(planner, scene)
        left = _ours() - before
        assert not left
    finally:
        gc.enable()


def _walk(planner: str, scene: str) -> None:
    """Go, stand, and want to go elsewhere: so what is offered to who stands is looked at, and not to its end."""
    controller = Controller(Humanoid.default(), Scene.load(scene), planner=planner)
    for command, turns in ((Command(forward=1.0), 30), (Command(), 30), (Command(strafe=1.0), 5)):
        for _ in range(turns):
            controller.step(command, 1.0 / 60.0)


def _ours() -> Counter[str]:
    """How many things of ours there are, by their kind."""
    kinds = (type(thing) for thing in gc.get_objects())
    return Counter(kind.__qualname__ for kind in kinds if str(kind.__module__).startswith("elbowroom."))


def test_a_place_has_a_map_of_room_while_somebody_walks_there() -> None:
    scene, before = Scene.load("d"), _ours()["FreeMap"]
    walkers = [Controller(Humanoid.default(), scene) for _ in range(2)]
    for walker in walkers:
        walker.step(Command(forward=1.0), 1.0 / 60.0)
    assert _ours()["FreeMap"] == before + 1
    del walker, walkers
    assert _ours()["FreeMap"] == before
