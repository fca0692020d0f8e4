"""How many capsule-box checks a second, on one core, beside the libraries that a user could take instead.

The other shapes are timed in turns with the boxes; so is the check of a frame among few and many obstacles.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import process_time

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.bench.capsule_inputs import capsule_inputs, shaped_obstacles
from elbowroom.experiment.bench.frame_check import FrameCosts, frame_costs
from elbowroom.experiment.bench.rivals import Rival, rivals
from elbowroom.experiment.bench.settings import CollisionSettings
from elbowroom.experiment.bench.vector_code import vector_bits
from elbowroom.world.obstacles.clearance import clearance, clearance_into

Bools = NDArray[np.bool_]

_CLOSE = 1e-6  # metres: nearer to touching than this, single precision may say either
_CALLS, _FEW_CALLS = 5, 2  # in a round; the best counts


@dataclass(frozen=True)
class Speed:
    """What one library did."""

    name: str
    call: str
    checks_per_second: float
    disagreements: int | None = None  # postures with another answer than ours, and not next to touching
    ratio: float | None = None  # our checks per second to theirs, the median of the rounds


@dataclass(frozen=True)
class CollisionReport:
    """The benchmark's figures."""

    vector_bits: int  # that the compiled kernel uses
    own: Speed
    rivals: tuple[Speed, ...]
    missing: tuple[str, ...]  # rivals that are not installed
    touching_share: float
    shapes: tuple[Speed, ...]  # ours against other shapes; `ratio` is that of boxes to them
    frame: FrameCosts


def run(settings: CollisionSettings, tick: Callable[[int], None] = lambda _: None) -> CollisionReport:
    """Time all in turns, round by round, so that a slow moment of the machine meets them alike."""
    inputs = capsule_inputs(settings.postures, settings.boxes, settings.seed)
    few = inputs.first(min(settings.rival_postures, settings.postures))
    others, missing = rivals(few)
    clear = clearance(few.segments, few.radii, few.boxes.standing)
    answers = [other.touching() for other in others]
    near, out = inputs.boxes.standing, np.empty(inputs.segments.shape[2], np.float32)
    own_call = partial(clearance_into, inputs.segments, inputs.radii, near, out)
    own_rates: list[float] = []
    shaped = shaped_obstacles(inputs, settings.seed)
    shape_rates: dict[str, list[float]] = {name: [] for name in shaped}
    rates: list[list[float]] = [[] for _ in others]
    for number in range(settings.rounds):
        own_rates.append(checks_per_second(inputs.checks, own_call))
        for name, other_near in shaped.items():
            shape_rates[name].append(
                checks_per_second(
                    inputs.checks, partial(clearance_into, inputs.segments, inputs.radii, other_near, out), _FEW_CALLS
                )
            )
        for i, other in enumerate(others):
            rates[i].append(checks_per_second(other.checks, other.touching))
        tick(number + 1)
    return CollisionReport(
        vector_bits=vector_bits(),
        own=Speed("Elbowroom", "clearance_into", float(np.median(own_rates))),
        rivals=tuple(
            _speed(other, own_rates, theirs, touching, clear)
            for other, theirs, touching in zip(others, rates, answers, strict=True)
        ),
        missing=tuple(missing),
        touching_share=float(np.mean(clear < 0.0)),
        shapes=tuple(
            Speed(name, "clearance_into", float(np.median(own)), ratio=float(np.median(own_rates) / np.median(own)))
            for name, own in shape_rates.items()
        ),
        frame=frame_costs(),
    )


def checks_per_second(checks: int, call: Callable[[], object], calls: int = _CALLS) -> float:
    """Checks a second of processor time, the same for all: other work on the machine counts little."""
    best = np.inf
    for _ in range(calls):
        began = process_time()
        call()
        best = min(best, process_time() - began)
    return checks / best


def _speed(other: Rival, own: list[float], theirs: list[float], touching: Bools, clear: NDArray[np.float32]) -> Speed:
    ratio = float(np.median(np.array(own) / np.array(theirs)))
    differs = (touching != (clear < 0.0)) & (np.abs(clear) > _CLOSE)
    return Speed(other.name, other.call, float(np.median(theirs)), int(differs.sum()), ratio)
