"""A place's map of room is shared by who holds it, and no longer."""

import gc
import pickle
from weakref import ref

import numpy as np

from elbowroom.world.scene import Scene


def test_who_holds_the_map_shares_it_and_nobody_else_keeps_it() -> None:
    obstacles = Scene.load("a").obstacles
    gc.disable()
    try:
        held = obstacles.free_map
        assert obstacles.free_map is held
        lent = ref(held)
        del held
        assert lent() is None
    finally:
        gc.enable()


def test_copies_of_a_place_travel_without_its_map_and_make_the_same() -> None:
    scene = Scene.load("a")
    low, high = np.array([-1.0, 0.0]), np.array([1.0, 2.0])
    held, empty = scene.free_map, len(pickle.dumps(scene))
    here = held.window(low, high)
    packed = pickle.dumps(scene)
    assert len(packed) == empty
    there = pickle.loads(packed).free_map.window(low, high)
    assert np.array_equal(here.distances, there.distances)
