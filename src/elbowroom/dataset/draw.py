"""What the seed of a dataset draws for each of its walks."""

from typing import NamedTuple

import numpy as np

from elbowroom.dataset.spec import STOCK, DatasetSpec


class DrawnWalk(NamedTuple):
    """What the seed draws for one walk."""

    place: str
    avatar: str
    steering: str
    seed: int
    swing: str = STOCK
    others: tuple[str, ...] = ()  # avatars of those who walk there too


def draw(spec: DatasetSpec, number: int) -> DrawnWalk:
    """What walk `number` is: the same whatever other walks there are."""
    rng = np.random.default_rng([spec.seed, number])
    lists = (spec.places, spec.avatars, spec.steering)
    place, avatar, steering = (choices[int(rng.integers(len(choices)))] for choices in lists)
    seed = int(rng.integers(2**31))
    swing = spec.swings[int(rng.integers(len(spec.swings)))]
    count = spec.company[int(rng.integers(len(spec.company)))]
    others = tuple(spec.avatars[int(rng.integers(len(spec.avatars)))] for _ in range(count))
    return DrawnWalk(place, avatar, steering, seed, swing, others)
