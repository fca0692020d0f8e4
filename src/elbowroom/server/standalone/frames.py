"""The frames of a recording as a live session would send them, so that a page can play them without a server."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import HEIGHT, RootState
from elbowroom.control.frame import contacts_of
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.control.recordings.recorded_things import told
from elbowroom.control.recordings.recording import ASSIST, STUCK, TOUCHING, Recording
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.export.shown import ShownFrames
from elbowroom.server.wire import pose_frame
from elbowroom.server.wire.pose import Poser
from elbowroom.server.wire.pose_frame import PoseFrame
from elbowroom.world.scene import Scene

MAX_BYTES = 40 * 2**20  # of all frames; of a longer run every second frame is sent, or every third ...
_LONGEST_NAME = 80  # characters


@dataclass(frozen=True)
class PosedRun:
    """A recording, posed on an avatar."""

    scene: dict[str, Any]  # as `Scene.from_dict` takes it
    planner: str
    avatar: str  # the id of the avatar that it was posed on; "" for the stock one
    stand_in: str  # the avatar that was recorded, where it is not known here and the stock one stands in; else ""
    note: str  # what is missing of the recording; else ""
    count: int
    frames: bytes  # `count` pose frames, one after the other, all of one size


def posed_run(path: Path, known: dict[str, AvatarReference]) -> PosedRun:
    """Read a recording and pose it on the avatar that it was made with, by its id if it is a known one.

    Raises `InputError`.
    """
    recording = Recording(path)
    humanoid, avatar, stand_in = _avatar_of(recording.header.avatar, known)
    scene = recording.scene()
    frames = _frames(_told(recording), humanoid, scene)
    header, note = recording.header, recording.note or ""
    return PosedRun(
        told(scene).to_dict() if len(recording.things) else header.scene,
        header.settings.planner,
        avatar,
        stand_in,
        note,
        len(frames),
        b"".join(frames),
    )


def posed_frames(recording: Recording, humanoid: Humanoid) -> list[bytes]:
    """The frames of a recording on an avatar, packed; raises `InputError`."""
    return _frames(_told(recording), humanoid, recording.scene())


def _told(recording: Recording) -> "_Told":
    shown, steps = ShownFrames.of(recording), recording.steps()
    return _Told(shown, steps["flags"], steps["phase"])


def _avatar_of(wanted: AvatarReference, known: dict[str, AvatarReference]) -> tuple[Humanoid, str, str]:
    """The humanoid to pose, its id, and for whom it stands in."""
    if wanted.stock:
        return Humanoid.default(), "", ""
    for avatar, reference in known.items():
        if reference.sha256 and replace(reference, name=wanted.name, path=wanted.path) == wanted:
            return wanted.load(Path(reference.path)), avatar, ""
    return Humanoid.default(), "", wanted.name[:_LONGEST_NAME] or "?"


@dataclass(frozen=True, eq=False)
class _Told:
    """What a recording tells of each frame."""

    shown: ShownFrames
    flags: NDArray[np.uint8]  # (N,) bits of `control.recordings.recording`
    phases: NDArray[np.uint8]  # (N,)


def _frames(told: _Told, humanoid: Humanoid, scene: Scene) -> list[bytes]:
    """The frames, packed; of those that are shown at one time the last, and no more than `MAX_BYTES` of them."""
    shown, poser, check = told.shown, Poser(humanoid), BodyCheck(humanoid, scene)
    last = np.append(np.diff(shown.times) > 0.0, True)
    size = pose_frame.HEAD_SIZE + 16 * len(humanoid.skeleton.names) + 24 * len(humanoid.capsules.names)
    sparsely = max(1, -(-int(last.sum()) * size // MAX_BYTES))
    epochs, passed = np.cumsum(shown.jumps), _passed(shown, scene)
    frames: list[bytes] = []
    for i in np.flatnonzero(last)[::sparsely].tolist():
        q, root, sim_time = shown.q[i], shown.roots[i], float(shown.clock[i])
        posed = poser.node_pose(q, root)
        frames.append(
            pose_frame.pack(
                PoseFrame(
                    flags=_bits(int(told.flags[i]), root) | pose_frame.FLAGS["finished"] * bool(passed[i]),
                    index=len(frames),
                    time=float(shown.times[i] - shown.times[0]),
                    sim_time=sim_time,
                    acknowledged=0,
                    epoch=int(epochs[i]) % 2**16,
                    avatar_revision=0,
                    phase=min(int(told.phases[i]), len(pose_frame.PHASES) - 1),
                    queue_fill=0,
                    x=root[0],
                    y=root[HEIGHT],
                    z=root[1],
                    heading=root[2],
                    forward=root[3],
                    lateral=root[4],
                    turn=root[5],
                    gait=root[6],
                    clearance=check.clearance(root, q[DOF - LOCAL :], sim_time),
                    hips_x=posed.hips[0],
                    hips_y=posed.hips[1],
                    hips_z=posed.hips[2],
                    rotations=posed.rotations,
                    capsules=poser.segments(q, root)[0],
                )
            )
        )
    return frames


def _bits(flags: int, root: NDArray[np.float64]) -> int:
    bits = pose_frame.FLAGS
    return (
        pose_frame.feet_bits(contacts_of(root))
        | bits["stuck"] * bool(flags & STUCK)
        | bits["touching"] * bool(flags & TOUCHING)
        | bits["assist"] * bool(flags & ASSIST)
    )


def _passed(shown: ShownFrames, scene: Scene) -> NDArray[np.bool_]:
    """Whether the finish had been passed at each frame (N,) since the last restart."""
    beyond = np.array([scene.finished(RootState.of(root)) for root in shown.roots])
    latest = np.maximum.accumulate(np.where(beyond, np.arange(len(beyond)), -1))
    begun = np.maximum.accumulate(np.where(shown.jumps, np.arange(len(beyond)), 0))
    return latest >= begun
