"""The binary message that carries one pose: a fixed head, then the joint rotations, then (if asked for) the capsules.

Little endian. All floats lie on multiples of 4 bytes, so that a client can lay a Float32Array over them.
"""

import struct
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

KIND = 1  # first byte: a pose frame
LAYOUT = 1  # second byte: version of this layout

# Name, struct code and meaning of each field of the head, in order.
HEAD: tuple[tuple[str, str, str], ...] = (
    ("kind", "B", "POSE_KIND"),
    ("layout", "B", "POSE_LAYOUT"),
    ("flags", "H", "bits of POSE_FLAGS"),
    ("index", "I", "number of the frame in its connection; gaps are frames that were dropped for a slow client"),
    ("time", "d", "session clock in seconds: never stops; interpolate by it"),
    ("sim_time", "d", "simulated seconds since the last reset"),
    ("acknowledged", "I", "seq of the last input that this frame obeys"),
    ("epoch", "H", "changes when the avatar jumps (reset, scene, avatar): do not interpolate across"),
    ("avatar_revision", "H", "revision of the avatar that is posed"),
    ("phase", "B", "index into POSE_PHASES"),
    ("queue_fill", "B", "key frames waiting"),
    ("joint_count", "H", "J"),
    ("capsule_count", "H", "C, 0 without the overlay"),
    ("reserved", "H", "0"),
    ("x", "f", "root position in metres"),
    ("y", "f", "root position in metres: height of the ground underfoot"),
    ("z", "f", "root position in metres"),
    ("heading", "f", "about +Y, 0 faces +Z, positive turns left; never wrapped"),
    ("forward", "f", "speed along the heading, m/s"),
    ("lateral", "f", "speed to the left, m/s"),
    ("turn", "f", "rad/s"),
    ("gait", "f", "gait phase in strides"),
    ("clearance", "f", "distance to the nearest obstacle in metres, Infinity without one, negative: touching"),
    ("hips_x", "f", "local translation of the hips node, in units of the file"),
    ("hips_y", "f", "see hipsX"),
    ("hips_z", "f", "see hipsX"),
)
FLAGS = {
    "stuck": 1,
    "touching": 2,
    "paused": 4,
    "assist": 8,
    "finished": 16,
    "left": 32,
    "right": 64,
}  # feet that stand
PHASES = ("plan", "play", "reset")

_HEAD = struct.Struct("<" + "".join(code for _, code, _ in HEAD))
HEAD_SIZE = _HEAD.size


def feet_bits(standing: NDArray[np.bool_]) -> int:
    """The flags of the feet, left and right (2,), that stand."""
    return FLAGS["left"] * bool(standing[0]) | FLAGS["right"] * bool(standing[1])


@dataclass(frozen=True, eq=False)
class PoseFrame:
    """One pose as it travels; see `HEAD` for meanings and units."""

    flags: int
    index: int
    time: float
    sim_time: float
    acknowledged: int
    epoch: int
    avatar_revision: int
    phase: int
    queue_fill: int
    x: float
    y: float
    z: float
    heading: float
    forward: float
    lateral: float
    turn: float
    gait: float
    clearance: float
    hips_x: float
    hips_y: float
    hips_z: float
    rotations: NDArray[np.float32]  # (J, 4) local rotations of the avatar file's nodes, xyzw
    capsules: NDArray[np.float32]  # (C, 6) end points in the world, or (0, 6)

    def flag(self, name: str) -> bool:
        """Whether a flag of `FLAGS` is set."""
        return bool(self.flags & FLAGS[name])


_SCALARS = tuple(f.name for f in fields(PoseFrame) if f.name not in ("rotations", "capsules"))


def offsets() -> dict[str, int]:
    """Byte offset of each head field, and of the first float after the head under the name `rotations`."""
    places, at = {}, 0
    for name, code, _ in HEAD:
        places[name] = at
        at += struct.calcsize("<" + code)
    return {**places, "rotations": at}


def pack(frame: PoseFrame) -> bytes:
    """The frame as it travels."""
    constants = {
        "kind": KIND,
        "layout": LAYOUT,
        "joint_count": len(frame.rotations),
        "capsule_count": len(frame.capsules),
        "reserved": 0,
    }
    values = [constants[name] if name in constants else getattr(frame, name) for name, _, _ in HEAD]
    rotations, capsules = frame.rotations.astype("<f4", copy=False), frame.capsules.astype("<f4", copy=False)
    return _HEAD.pack(*values) + rotations.tobytes() + capsules.tobytes()


def parse(data: bytes) -> PoseFrame:
    """Read a frame: for clients written in Python, and for tests; raises ValueError if it is none."""
    if len(data) < HEAD_SIZE:
        raise ValueError(f"a pose frame has at least {HEAD_SIZE} bytes, not {len(data)}")
    head = dict(zip((name for name, _, _ in HEAD), _HEAD.unpack_from(data), strict=True))
    joints, capsules = head["joint_count"], head["capsule_count"]
    if (head["kind"], head["layout"]) != (KIND, LAYOUT) or len(data) != HEAD_SIZE + 16 * joints + 24 * capsules:
        raise ValueError("not a pose frame of this layout")
    floats = np.frombuffer(data, "<f4", offset=HEAD_SIZE)
    return PoseFrame(
        **{name: head[name] for name in _SCALARS},
        rotations=floats[: 4 * joints].reshape(joints, 4),
        capsules=floats[4 * joints :].reshape(capsules, 6),
    )
