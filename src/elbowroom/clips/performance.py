"""A clip as an avatar performs it: the whole body as recorded, and beside it what planning keeps of it."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.body.skeleton import Skeleton
from elbowroom.clips.clip import Clip
from elbowroom.clips.planning_motion import upper_body
from elbowroom.clips.retarget import retarget
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_ON_THE_SPOT = 0.3  # metres between a loop's beginning and end that are not seen as a jump


class PlayedPose(NamedTuple):
    """The avatar at one time."""

    root: Floats  # (7,) root state
    upper: Floats  # (LOCAL,) the local groups, as planning keeps them
    rotations: Floats  # (J, 4) normalised local rotations; the hips' own is in the root's axes
    hips: Floats  # (3,) the hips joint in the root's frame, metres


@dataclass(frozen=True, eq=False)
class Performance:
    """A clip on one avatar, frame by frame."""

    frame_time: float  # seconds
    roots: Floats  # (F, 7)
    uppers: Floats  # (F, LOCAL)
    rotations: Floats  # (F, J, 4)
    hips: Floats  # (F, 3)
    loop: int  # frames after which it begins anew, where its end fits its beginning; else 0

    @property
    def duration(self) -> float:
        """Seconds until it begins anew."""
        return (self.loop or max(len(self.roots) - 1, 1)) * self.frame_time

    @property
    def seamless(self) -> bool:
        """Whether it goes on at its end without a jump."""
        return bool(self.loop and np.linalg.norm(self.roots[-1, :2] - self.roots[0, :2]) < _ON_THE_SPOT)

    def at(self, time: float) -> PlayedPose:
        """The moment `time` seconds after the beginning, at most `duration`."""
        place = min(time, self.duration) / self.frame_time
        before = min(int(place), len(self.roots) - 1)
        after = before + 1 if before + 1 < len(self.roots) else 0 if self.loop else before
        share = min(place - before, 1.0)

        def between(rows: Floats) -> Floats:
            mixed: Floats = rows[before] + share * (rows[after] - rows[before])
            return mixed

        root = between(self.roots) if after > before else self.roots[before]
        turns = quaternion.slerp(self.rotations[before], self.rotations[after], np.full(1, share))
        return PlayedPose(root, between(self.uppers), turns, between(self.hips))


def perform(clip: Clip, skeleton: Skeleton, start: RootState) -> Performance:
    """Put a clip on an avatar that begins at `start`."""
    track, played = clip.planning.track, retarget(clip.motion, skeleton)
    states = track.states.copy()
    states[:, :2] *= played.scale
    states[:, 3:5] *= played.scale
    back = quaternion.about_axis(1, -states[:, 2])
    rotations = played.rotations
    rotations[:, 0] = quaternion.multiply(back, rotations[:, 0])
    ground = np.stack([states[:, 0], np.zeros(len(states)), states[:, 1]], axis=1)
    hips = quaternion.rotate(back, played.hips - ground)
    return Performance(
        played.frame_time, _placed(states, start), upper_body(clip.planning), rotations, hips, track.strides.loop
    )


def _placed(states: Floats, start: RootState) -> Floats:
    """Root states (F, 7) moved and turned as a whole, so that the first stands at `start`."""
    placed = states.copy()
    turn = start.heading - states[0, 2]
    x, z = (states[:, :2] - states[0, :2]).T
    placed[:, 0] = start.x + x * np.cos(turn) + z * np.sin(turn)
    placed[:, 1] = start.z - x * np.sin(turn) + z * np.cos(turn)
    placed[:, 2] += turn
    return placed
