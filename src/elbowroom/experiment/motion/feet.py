"""What the feet of a walk do: slide, sink in, clear the ground, stand."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT, RISES
from elbowroom.experiment.motion.borne import Borne, borne, shares
from elbowroom.experiment.motion.sole import SolePoints
from elbowroom.experiment.motion.stance import slides, standing_by_looks, stretches
from elbowroom.experiment.motion.walked import RATE, Walked
from elbowroom.jit import exact_kernel
from elbowroom.world.ground.ground import Ground, height_at

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_MIDDLE = (0.3, 0.8)  # of a swing: where a foot passes the other one
_SWING = 5  # frames that a swing has at least


@dataclass(frozen=True)
class Slides:
    """How far feet slide while they stand, millimetres."""

    stances: int
    median: float
    p99: float
    worst: float


@dataclass(frozen=True)
class Feet:
    """The feet in the walks of one case."""

    as_planned: Slides  # while the walk says that they stand
    by_looks: Slides  # from when they have come to rest until they are lifted
    in_ground: float  # millimetres that the lowest point of a sole is below the ground at most
    clearance: float | None  # millimetres: the least height of a sole in the middle of a swing; None without a swing
    borne: Borne  # how much of the soles has ground under it


@dataclass(frozen=True, eq=False)
class FootTrack:
    """One foot in one walk."""

    points: Floats  # (N, P, 3) of its sole, heights those above the ground
    planned: Bools  # (N,)
    seen: Bools  # (N,)
    flat: Floats  # (P, 2) as in `SolePoints`
    body: Floats  # (N,) how high the body's place is, metres

    def clearances(self) -> Floats:
        """The least height of the sole in the middle of each swing, metres."""
        lowest, found = self.points[:, :, 1].min(axis=1), []
        for swing in stretches(~self.planned):
            length = swing.stop - swing.start
            whole = swing.start > 0 and swing.stop < len(lowest)
            if whole and length >= _SWING:
                first, end = (swing.start + round(part * length) for part in _MIDDLE)
                found.append(float(lowest[first : end + 1].min()))
        return np.array(found)


def foot_tracks(walked: Walked, soles: Sequence[SolePoints]) -> tuple[FootTrack, FootTrack]:
    """Left and right foot of a walk, from where it is settled."""
    span, ground = walked.settled(), walked.script.scene.ground
    tracks = []
    for side, sole in enumerate(soles):
        points, near = (
            sole.points(walked.joints)[span],
            walked.roots[span, HEIGHT] + walked.roots[span, RISES + 2 * side],
        )
        points[:, :, 1] -= _under(ground, np.ascontiguousarray(points), near)
        planned, seen = walked.standing[span, side], standing_by_looks(points, RATE)
        tracks.append(FootTrack(points, planned, seen, sole.flat, walked.roots[span, HEIGHT]))
    left, right = tracks
    return left, right


@exact_kernel
def _under(ground: Ground, points: Floats, near: Floats) -> Floats:
    """The ground (N, P) under points (N, P, 3), about the heights `near` (N,)."""
    found = np.zeros(points.shape[:2])
    for n in range(points.shape[0]):
        for p in range(points.shape[1]):
            found[n, p] = height_at(ground, points[n, p, 0], points[n, p, 2], near[n])
    return found


def feet(tracks: Sequence[FootTrack]) -> Feet:
    """The figures of some feet together."""
    clearances = np.concatenate([track.clearances() for track in tracks])
    return Feet(
        slides_of([slides(track.points, track.planned) for track in tracks]),
        slides_of([slides(track.points, track.seen) for track in tracks]),
        max(0.0, -1e3 * min(float(track.points[:, :, 1].min()) for track in tracks)),
        1e3 * float(clearances.min()) if len(clearances) else None,
        borne(shares(track.points[:, :, 1], track.planned, track.flat, track.body) for track in tracks),
    )


def slides_of(found: Sequence[Floats]) -> Slides:
    """The figures of slides in metres."""
    every = 1e3 * np.concatenate([*found, np.empty(0)])
    if not len(every):
        return Slides(0, 0.0, 0.0, 0.0)
    return Slides(len(every), float(np.median(every)), float(np.percentile(every, 99)), float(every.max()))
