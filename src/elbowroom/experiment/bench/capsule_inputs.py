"""The inputs of the collision benchmark: an arm in many postures among a few boxes, the same for every library."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, clamp, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model, group_capsules
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import rows_of
from elbowroom.world.obstacles.shapes import Capsule, Cylinder, Hull, Shape, Sphere

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_Z = np.array([0.0, 0.0, 1.0])


class CapsuleInputs(NamedTuple):
    """C capsules in N postures against B boxes, single precision as the kernels take it."""

    segments: Floats32  # (C, 6, N) metres
    radii: Floats32  # (C,)
    boxes: Obstacles

    @property
    def checks(self) -> int:
        """Pairs of a capsule and a box."""
        return len(self.radii) * len(self.boxes) * int(self.segments.shape[2])

    def first(self, count: int) -> "CapsuleInputs":
        """The same with fewer postures."""
        return self._replace(segments=np.ascontiguousarray(self.segments[:, :, :count]))

    @property
    def lengths(self) -> Floats:
        """Of the axes (C,)."""
        ends = self.segments[:, :, 0].astype(np.float64)
        lengths: Floats = np.linalg.norm(ends[:, 3:] - ends[:, :3], axis=1)
        return lengths

    def placements(self) -> tuple[Floats, Floats]:
        """Middles (N, C, 3) of the capsules, and rotations (N, C, 4) that turn +Z along their axes."""
        ends = np.moveaxis(self.segments.astype(np.float64), 2, 0)
        axes = ends[..., 3:] - ends[..., :3]
        flat = axes.reshape(-1, 3)
        turns = quaternion.between(np.tile(_Z, (len(flat), 1)), flat)
        return 0.5 * (ends[..., :3] + ends[..., 3:]), turns.reshape(*axes.shape[:2], 4)


def shaped_obstacles(inputs: CapsuleInputs, seed: int) -> dict[str, Nearby]:
    """Random obstacles of the other shapes, as large as the boxes and in their places."""
    rng = np.random.default_rng(seed)

    def hull(size: Floats, points: int) -> Hull:
        rows = rng.normal(size=(points, 3))
        rows *= size / np.linalg.norm(rows, axis=1, keepdims=True)
        return Hull(tuple((x, y, z) for x, y, z in rows.tolist()))

    made: dict[str, Callable[[Floats], Shape]] = {
        "spheres": lambda half: Sphere(float(half.min())),
        "capsules": lambda half: Capsule(float(half[0]), 2.0 * float(half[1])),
        "cylinders": lambda half: Cylinder(float(half[0]), 2.0 * float(half[1])),
        "hulls of 8 points": lambda half: hull(half, 8),
        "hulls of 20 points": lambda half: hull(half, 20),
        "hulls of 60 points": lambda half: hull(half, 60),
    }
    boxes = inputs.boxes
    return {
        name: rows_of([make(half) for half in boxes.half_sizes], boxes.centers, boxes.rotations)
        for name, make in made.items()
    }


def capsule_inputs(postures: int, boxes: int, seed: int) -> CapsuleInputs:
    """A man's left arm in random postures within its limits, and random boxes within its reach."""
    rng = np.random.default_rng(seed)
    model = body_model(proportional_humanoid())
    low, high = limits(DofGroup.LEFT_ARM).T
    arms = clamp(DofGroup.LEFT_ARM, rng.uniform(low, high, (postures, len(low))))
    segments = group_capsules(model, DofGroup.LEFT_ARM, arms)
    shoulder = segments[0, :3].mean(axis=1)
    towards = rng.normal(size=(boxes, 3))
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    centers = shoulder + towards * rng.uniform(0.5, 0.85, (boxes, 1))
    turns = quaternion.normalize(rng.normal(size=(boxes, 4)))
    radii = model.capsules_of(DofGroup.LEFT_ARM).radii
    return CapsuleInputs(segments, radii, Obstacles.boxes(centers, turns, rng.uniform(0.05, 0.22, (boxes, 3))))
