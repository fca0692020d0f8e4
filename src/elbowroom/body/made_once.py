"""What follows from a humanoid alone is made once, for all who walk as it, and lives as long as it does."""

from collections.abc import Callable
from functools import wraps
from threading import Lock
from typing import TypeVar
from weakref import WeakKeyDictionary

from elbowroom.body.humanoid import Humanoid

Thing = TypeVar("Thing")


def made_once(make: Callable[[Humanoid], Thing]) -> Callable[[Humanoid], Thing]:
    """Have a function return what it made of a humanoid before; nobody may change that. Any thread may ask."""
    made: WeakKeyDictionary[Humanoid, Thing] = WeakKeyDictionary()
    lock = Lock()

    @wraps(make)
    def known(humanoid: Humanoid) -> Thing:
        with lock:
            if humanoid not in made:
                made[humanoid] = make(humanoid)
            return made[humanoid]

    return known
