"""What follows from a humanoid alone is made once and goes with it."""

import gc
import weakref
from concurrent.futures import ThreadPoolExecutor

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.made_once import made_once
from elbowroom.body.pose.kinematics import body_model


def test_all_who_walk_as_one_humanoid_share_its_model() -> None:
    one, other = proportional_humanoid(1.7), proportional_humanoid(1.7)
    assert body_model(one) is body_model(one)
    assert body_model(one) is not body_model(other)


def test_threads_that_ask_at_once_get_the_same() -> None:
    humanoid = proportional_humanoid(1.6)
    with ThreadPoolExecutor(4) as pool:
        first, *others = pool.map(lambda _: body_model(humanoid), range(8))
    assert all(other is first for other in others)


class _Made:
    pass


def test_what_was_made_goes_with_its_humanoid() -> None:
    @made_once
    def make(humanoid: Humanoid) -> _Made:
        del humanoid
        return _Made()

    humanoid = proportional_humanoid(1.5)
    made = weakref.ref(make(humanoid))
    assert made() is not None
    del humanoid
    gc.collect()
    assert made() is None
