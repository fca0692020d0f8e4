"""The pose of a VRM as three-vrm shows it: the same normalised rotations put every bone in the same place."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from avatar_builder import Recipe, build
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid, load_humanoid_bytes
from elbowroom.body.stock import stock_avatar_path
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.geometry import quaternion
from elbowroom.server.wire.pose import Poser
from shared_data import SHARED
from three_judge import ThreeJudge

Floats = NDArray[np.float64]

POSES = 6
CLOSE = 1e-4  # radians, and metres for each metre of the avatar's height
REAL = [stock_avatar_path(), *(sorted(SHARED.glob("avatars/vrm[01]/*.vrm")) if SHARED else [])]
MADE = [
    Recipe(vrm="1", mesh=False, spin=True, between=True),
    Recipe(vrm="1", mesh=False, root_scale=0.5, unit=1.2),
    Recipe(vrm="0", mesh=False, heading=np.pi, spin=True),
]


@pytest.fixture(scope="module")
def three(chromium: Any) -> Iterator[ThreeJudge]:
    judge = ThreeJudge(chromium)
    yield judge
    judge.close()


def random_rotations(rng: np.random.Generator, joints: int) -> Floats:
    """Rotations (J, 4) about any axis, up to half a turn."""
    axes = rng.normal(size=(joints, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    return quaternion.from_rotation_vector(axes * rng.uniform(-np.pi, np.pi, (joints, 1)))


def as_three_vrm_takes_it(humanoid: Humanoid, rotations: Floats, hips: Floats) -> dict[str, Any]:
    """Our pose in three-vrm's terms: in the axes and units of the file, which in VRM 0.x faces -Z."""
    assert humanoid.rig is not None
    facing = quaternion.about_axis(1, humanoid.rig.facing)
    turned = quaternion.multiply(quaternion.multiply(facing, rotations), quaternion.conjugate(facing))
    named = dict(zip(humanoid.skeleton.names, turned.tolist(), strict=True))
    return {"rotations": named, "hips": humanoid.rig.to_file(hips).tolist()}


def as_the_server_sends_it(humanoid: Humanoid, rotations: Floats, hips: Floats) -> tuple[Floats, Floats]:
    """World positions (J, 3) and rotations (J, 4) of the bones' nodes, the file's axes and units."""
    assert humanoid.glb is not None
    assert humanoid.rig is not None
    pose = Poser(humanoid).full_pose(rotations, hips)
    tree, nodes = read_nodes(parse_gltf(humanoid.glb, humanoid.name)), humanoid.rig.nodes
    local = tree.rotations.copy()
    local[nodes] = pose.rotations
    tree.translations[nodes[0]] = pose.hips
    return tree.world_matrices(local)[nodes, :3, 3], tree.world_rotations(local)[nodes]


def compare(three: ThreeJudge, humanoid: Humanoid, data: bytes) -> None:
    rng = np.random.default_rng(5)
    joints = len(humanoid.skeleton.names)
    postures = [(random_rotations(rng, joints), rng.normal(size=3)) for _ in range(POSES)]
    asked = [as_three_vrm_takes_it(humanoid, *posture) for posture in postures]
    theirs = three.poses(data, asked)["shown"]
    assert humanoid.rig is not None
    height = humanoid.skeleton.height / humanoid.rig.scale
    for posture, shown in zip(postures, theirs, strict=True):
        places, turns = as_the_server_sends_it(humanoid, *posture)
        for joint, bone in enumerate(humanoid.skeleton.names):
            found = np.array(shown.pop(bone))
            assert np.linalg.norm(places[joint] - found[:3]) <= CLOSE * height, bone
            assert quaternion.angle_between(turns[joint], found[3:]) <= CLOSE, bone
        assert not shown, "bones that three-vrm has and we have not"


@pytest.mark.parametrize(
    "path",
    [*REAL[::2], *(pytest.param(path, marks=pytest.mark.long) for path in REAL[1::2])],
    ids=lambda path: path.stem,
)
def test_real_files_are_posed_as_in_three_vrm(three: ThreeJudge, path: Path) -> None:
    compare(three, load_humanoid(path), path.read_bytes())


@pytest.mark.parametrize("recipe", MADE, ids=["nodes between", "scaled", "facing back"])
def test_made_files_are_posed_as_in_three_vrm(three: ThreeJudge, recipe: Recipe) -> None:
    data = build(recipe)
    compare(three, load_humanoid_bytes(data, "made.vrm"), data)
