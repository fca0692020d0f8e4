"""How well a collision body holds its avatar's surface: by area, and at its worst place."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.capsules import Capsules
from elbowroom.body.fitting.body_parts import BodyPoints, leans_on, part_of_points
from elbowroom.body.fitting.fit import MARGIN, FitSettings
from elbowroom.body.fitting.flexing import FlexedPoses, PosedPoints, poses_of
from elbowroom.body.fitting.proportions import proportional_capsules
from elbowroom.body.fitting.slim_capsule import Slim
from elbowroom.body.skeleton import Skeleton

Floats = NDArray[np.float64]

WANTED = FitSettings().covered  # of the surface
_FEWEST = FitSettings().fewest  # samples: of less surface nothing is said


@dataclass(frozen=True)
class Coverage:
    """How much of the surface is inside the capsules of the joint that carries it, or at most `MARGIN` outside.

    What belongs to the legs may be inside of any that it `leans_on`, in the poses that samples are in.
    """

    share: float  # of the whole area
    parts: dict[str, float]  # the same for each part of the body that has a surface
    worst: float  # metres that the surface is outside at its worst place; 0 where it is nowhere
    worst_part: str  # where that is

    @property
    def is_enough(self) -> bool:
        """Whether the avatar's surface may be taken to be where its capsules are."""
        return self.share >= WANTED


def coverage(skeleton: Skeleton, capsules: Capsules, samples: BodyPoints) -> Coverage | None:
    """The coverage of a surface by capsules; None without a surface on any part."""
    average = proportional_capsules(skeleton)
    parts = part_of_points(skeleton, average, samples)
    counted = [part for part in range(len(average.names)) if np.count_nonzero(parts == part) >= _FEWEST]
    if not counted:
        return None
    poses = poses_of(skeleton)
    outside = []
    for part in counted:
        beside, joint = leans_on(average, part), average.joints[part]
        own = [i for i, name in enumerate(capsules.names) if name.split()[0] in beside or capsules.joints[i] == joint]
        points = poses.sampled(samples, np.flatnonzero(parts == part))
        outside.append(_outside(skeleton, capsules, own, points, poses))
    names = [average.names[part] for part in counted]
    worst = int(np.argmax([gaps.max() for gaps in outside]))
    return Coverage(
        share=float(np.mean(np.concatenate(outside) <= MARGIN)),
        parts={name: float(np.mean(gaps <= MARGIN)) for name, gaps in zip(names, outside, strict=True)},
        worst=max(float(outside[worst].max()), 0.0),
        worst_part=names[worst],
    )


def _outside(
    skeleton: Skeleton, capsules: Capsules, some: list[int], points: PosedPoints, poses: FlexedPoses
) -> Floats:
    """How far points (P,) are outside all of some capsules, metres; negative inside."""
    gaps = np.full(len(points.places), np.inf)
    for i in some:
        joint = int(capsules.joints[i])
        rest = skeleton.positions[joint]
        slim = Slim(capsules.starts[i] + rest, capsules.ends[i] + rest, float(capsules.radii[i]))
        gaps = np.minimum(gaps, poses.outside(slim, joint, points))
    return gaps
