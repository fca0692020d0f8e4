"""What the check of a shown frame costs among few and among many obstacles, equally dense."""

from dataclasses import dataclass, replace
from time import process_time

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

FEW, MANY = 100, 10_000
_APART = 1.0  # metres between boxes
_FRAMES, _ROUNDS = 200, 7


@dataclass(frozen=True)
class FrameCosts:
    """Milliseconds of processor time for the check of one frame."""

    few_ms: float  # among `FEW` boxes
    many_ms: float  # among `MANY`
    ratio: float


def frame_costs() -> FrameCosts:
    """Check frames of a standing avatar at random places, among few and among many boxes in turns; the best round."""
    humanoid, rng = Humanoid.default(), np.random.default_rng(5)
    places = rng.uniform(-4.0, 4.0, (_FRAMES, 2))
    checks = [BodyCheck(humanoid, _field(count)) for count in (FEW, MANY)]
    best = [np.inf, np.inf]
    for _ in range(_ROUNDS):
        for i, check in enumerate(checks):
            best[i] = min(best[i], _once(check, places))
    few, many = best
    return FrameCosts(few, many, many / few)


def _field(count: int) -> Scene:
    """Boxes on a square grid about the origin."""
    side = round(count**0.5)
    at = _APART * (np.arange(side) - 0.5 * (side - 1))
    x, z = (axis.ravel() for axis in np.meshgrid(at, at))
    centers = np.stack([x, np.full(len(x), 0.5), z], axis=1)
    turns, halves = np.tile(quaternion.IDENTITY, (len(x), 1)), np.full((len(x), 3), 0.1)
    return replace(Scene.load("empty"), obstacles=Obstacles.boxes(centers, turns, halves))


def _once(check: BodyCheck, places: Floats) -> float:
    """Milliseconds a frame."""
    root, upper = np.zeros(ROOT_STATE), np.zeros(LOCAL)
    check.clearance(root, upper, 0.0)
    began = process_time()
    for place in places:
        root[:2] = place
        check.clearance(root, upper, 0.0)
    return 1e3 * (process_time() - began) / len(places)
