"""The columns of a dataset's files: one row is one walk, and what it holds for each frame is a list."""

from collections.abc import Iterator
from typing import NamedTuple

import pyarrow as pa

from elbowroom.body.dof import DOF
from elbowroom.body.root import CARRIAGE, HEIGHT, TOLD_FEET

# The 22 body joints of SMPL in its order, each by the VRM bone that begins there. Loper et al. 2015; SMPL+H leaves the
# hands' own joints to the hands. A bone that an avatar lacks is where the nearest bone above it begins.
SMPL_BONES = (
    "hips", "leftUpperLeg", "rightUpperLeg", "spine", "leftLowerLeg", "rightLowerLeg", "chest", "leftFoot",
    "rightFoot", "upperChest", "leftToes", "rightToes", "neck", "leftShoulder", "rightShoulder", "head",
    "leftUpperArm", "rightUpperArm", "leftLowerArm", "rightLowerArm", "leftHand", "rightHand",
)  # fmt: skip


class Column(NamedTuple):
    """One column."""

    name: str
    kind: pa.DataType
    about: str  # shape and unit, for the card


def _frames(width: int, kind: pa.DataType) -> pa.DataType:
    return pa.list_(pa.list_(kind, width))


F32 = pa.float32()
_JOINTS, _TURNS = 3 * len(SMPL_BONES), 4 * len(SMPL_BONES)

COLUMNS = (
    Column("walk", pa.int64(), "number of the walk; it and the seed of the dataset decide all else"),
    Column("place", pa.string(), "random courses of a level, a stock scene, or the name of a file"),
    Column("avatar", pa.string(), "`stock` or the name of a file"),
    Column("swing", pa.string(), "`stock`, the style, or the clip that is walked as"),
    Column("steering", pa.string(), "how the user steers"),
    Column("seed", pa.int64(), "of the course, or of the start in the scene"),
    Column("fps", pa.int32(), "frames a second"),
    Column("frames", pa.int32(), "F"),
    Column("reached", pa.bool_(), "whether the finish was reached"),
    Column("stuck_frames", pa.int32(), "frames in which the user pushed and there was no way on"),
    Column("scene", pa.string(), "the place as JSON of a scene: obstacles, start, finish; of a model its file's name"),
    Column("obstacles", pa.list_(pa.string()), "(B,) names of the obstacles, by number"),
    Column("time", pa.list_(F32), "(F,) seconds since the start"),
    Column("command", _frames(4, F32), "(F, 4) forward, strafe, turn in -1..1, direction in radians or NaN"),
    Column("root", _frames(HEIGHT, F32), "(F, 7) x, z, heading, their velocities in the body's axes, strides"),
    Column("height", pa.list_(F32), "(F,) metres, of the ground that the root is over"),
    Column("feet", _frames(TOLD_FEET, F32), "(F, 18) both feet as in body/gait/foot_state.py, 0 on uneven ground"),
    Column("carriage", _frames(CARRIAGE, F32), "(F, 13) hips, trunk as in body/gait/carriage.py, 0 on uneven ground"),
    Column("q", _frames(DOF, F32), f"(F, {DOF}) configuration, radians; see the architecture page"),
    Column("joints", _frames(_JOINTS, F32), "(F, 66) places x, y, z of the 22 SMPL joints in the world, metres"),
    Column("rotations", _frames(_TURNS, F32), "(F, 88) rotations x, y, z, w of their VRM bones, normalised, local"),
    Column("contacts", _frames(2, pa.bool_()), "(F, 2) whether the left, the right foot stands"),
    Column("clearance", pa.list_(F32), "(F,) metres from the body to the nearest obstacle, infinite without any"),
    Column("nearest", pa.list_(pa.int32()), "(F,) number of that obstacle, -1 without any"),
    Column("others", pa.list_(pa.string()), "(N,) avatars of those who walk about in the same place"),
    Column("others_root", pa.list_(pa.list_(F32)), "(N, 8 F) of each: root and height as above, frame after frame"),
    Column("others_joints", pa.list_(pa.list_(F32)), "(N, 66 F) of each: joints as above, frame after frame"),
    Column("near", pa.list_(pa.list_(pa.int32())), "(F, any) numbers of what stands within 3 m, and of all that moves"),
)  # fmt: skip

SCHEMA = pa.schema([pa.field(column.name, column.kind, nullable=False) for column in COLUMNS])


def leaves(schema: pa.Schema) -> Iterator[tuple[str, pa.DataType]]:
    """The paths of a Parquet file's columns of plain values, and of what kind these are."""
    for field in schema:
        path, kind = field.name, field.type
        while pa.types.is_list(kind) or pa.types.is_fixed_size_list(kind):
            path, kind = f"{path}.list.element", kind.value_type
        yield path, kind
