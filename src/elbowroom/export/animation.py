"""An animation: what a recording shows, on one avatar, at even steps of time."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, joint_pose
from elbowroom.body.root import HEIGHT
from elbowroom.body.skeleton import Skeleton
from elbowroom.control.recordings.recording import Recording
from elbowroom.errors import InputError
from elbowroom.export.formats import check_rate
from elbowroom.export.shown import ShownFrames, even_moments
from elbowroom.formats.takes import MAX_FRAMES, MAX_POSES
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Animation:
    """Frames of a body as the page shows them."""

    name: str
    fps: float  # frames a second
    skeleton: Skeleton
    rotations: Floats  # (F, J, 4) normalised local rotations; the hips' own is in the root's axes
    hips: Floats  # (F, 3) the hips joint in the root's frame, metres
    places: Floats  # (F, 3) the root's origin in the world: on the ground under the body, metres
    headings: Floats  # (F,) of the root, radians about +Y, not wrapped
    scene_times: Floats | None = None  # (F,) the scene's own time, by which things move; None: from 0 on

    def __len__(self) -> int:
        return len(self.rotations)

    @classmethod
    def of(cls, recording: Recording, humanoid: Humanoid, fps: float = 60.0) -> "Animation":
        """The frames of a recording at `fps` frames a second.

        Between two frames as on the page: joints turn by the shortest arc, root and hips go in straight lines.
        Raises `InputError` for a recording that shows nothing or too much, and a rate out of range.
        """
        shown = ShownFrames.of(recording)
        check_length(str(recording.path), shown.duration, humanoid, fps)
        rotations, hips = posed_frames(humanoid, shown.q, shown.roots)
        places = shown.roots[:, [0, HEIGHT, 1]]
        poses = ShownPoses(shown.times, shown.jumps, rotations, hips, places, shown.roots[:, 2], shown.clock)
        return cls.of_poses(recording.path.stem, humanoid.skeleton, poses, fps)

    @classmethod
    def of_poses(cls, name: str, skeleton: Skeleton, poses: "ShownPoses", fps: float) -> "Animation":
        """The same of poses at any times."""
        before, after, share = even_moments(poses.times, poses.jumps, fps)
        part = share[:, None]

        def between(rows: Floats) -> Floats:
            return rows[before] + (part if rows.ndim > 1 else share) * (rows[after] - rows[before])

        turned = quaternion.slerp(poses.rotations[before], poses.rotations[after], part)
        clock = None if poses.clock is None else between(poses.clock)
        hips, places, headings = between(poses.hips), between(poses.places), between(poses.headings)
        return cls(name, fps, skeleton, turned, hips, places, headings, clock)

    @property
    def clock(self) -> Floats:
        """The scene's own time (F,) at every frame, seconds."""
        return np.arange(len(self)) / self.fps if self.scene_times is None else self.scene_times

    def turns(self) -> Floats:
        """Rotations (F, 4) of the root in the world."""
        return quaternion.about_axis(1, self.headings)

    def hips_in_world(self) -> tuple[Floats, Floats]:
        """Place (F, 3) and rotation (F, 4) of the hips joint in the world."""
        turns = self.turns()
        return self.places + quaternion.rotate(turns, self.hips), quaternion.multiply(turns, self.rotations[:, 0])

    def joints_in_world(self) -> Floats:
        """Places (F, J, 3) of all joints in the world, metres."""
        rotations = self.rotations.copy()
        hips, rotations[:, 0] = self.hips_in_world()
        return self.skeleton.joints(rotations, hips)


@dataclass(frozen=True, eq=False)
class ShownPoses:
    """What was shown at some times; see `Animation` for the rest."""

    times: Floats  # (N,) seconds, not decreasing
    jumps: NDArray[np.bool_]  # (N,) the pose does not follow from the one before it
    rotations: Floats  # (N, J, 4)
    hips: Floats  # (N, 3)
    places: Floats  # (N, 3)
    headings: Floats  # (N,)
    clock: Floats | None = None  # (N,) the scene's own time


def check_length(place: str, seconds: float, humanoid: Humanoid, fps: float) -> None:
    """Raises `InputError` for a rate out of range, and for more frames than fit."""
    check_rate(fps)
    most = min(MAX_FRAMES, MAX_POSES // len(humanoid.skeleton.names))
    if seconds * fps >= most:
        long = f"{seconds:.0f} s at {fps:g} frames a second"
        raise InputError(f"{place}: {long} are more than the {most} frames that fit: lower --fps")


def posed_frames(humanoid: Humanoid, q: Floats, roots: Floats) -> tuple[Floats, Floats]:
    """Normalised local rotations (N, J, 4) and hips (N, 3) in the root's frame of frames (N, DOF), (N, 7)."""
    model = body_model(humanoid)
    rotations, hips = zip(
        *(joint_pose(model, posture, root) for posture, root in zip(q, roots, strict=True)), strict=True
    )
    return np.stack(rotations), np.stack(hips)
