"""BVH files that we write: read again by ourselves and by bvhio, the joints are where they were."""

from pathlib import Path

import bvhio
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from elbowroom.formats.bvh import parse_bvh
from elbowroom.formats.bvh_writing import euler_angles, write_bvh
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.takes import Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def made_take(seed: int, frames: int = 20, joints: int = 9) -> Take:
    """A random tree of joints that turn smoothly through more than whole turns; two also move."""
    rng = np.random.default_rng(seed)
    parents = np.array([-1] + [int(rng.integers(i)) for i in range(1, joints)])
    t = np.linspace(0.0, 1.0, frames)[:, None, None]
    turns = quaternion.from_rotation_vector(4.0 * t * rng.normal(size=(joints, 3)) + rng.normal(size=(joints, 3)))
    offsets = rng.normal(size=(joints, 3))
    places = np.tile(offsets, (frames, 1, 1))
    places[:, [0, 3]] += t * rng.normal(size=(2, 3))
    nothing, ones = np.full(joints, -1), np.ones((joints, 3))
    still = np.tile(quaternion.IDENTITY, (joints, 1))
    names = tuple(f"joint{i}" for i in range(joints))
    return Take(
        "made", NodeTree(names, parents, np.arange(joints), offsets, still, ones, nothing, nothing), 0.02, turns, places
    )


def world(take: Take, names: tuple[str, ...]) -> Floats:
    return take.world(np.array([take.tree.names.index(name) for name in names]))[1]


@pytest.mark.parametrize("order", ORDERS)
def test_a_file_comes_back_as_it_was(order: str) -> None:
    take = made_take(ORDERS.index(order))
    again = parse_bvh(write_bvh(take, {}, order), "made.bvh").take()
    assert again.frame_time == pytest.approx(take.frame_time, abs=1e-9)
    np.testing.assert_allclose(world(again, take.tree.names), world(take, take.tree.names), atol=1e-6)


@pytest.mark.parametrize("order", ORDERS)
def test_bvhio_reads_the_same(order: str, tmp_path: Path) -> None:
    take = made_take(10 + ORDERS.index(order))
    path = tmp_path / "made.bvh"
    path.write_bytes(write_bvh(take, {}, order))
    root = bvhio.readAsHierarchy(str(path))
    for frame in (0, 7, 19):
        root.loadPose(frame)
        theirs = {joint.Name: list(joint.PositionWorld) for joint, _, _ in root.layout()}
        wanted = world(take, take.tree.names)[frame]
        np.testing.assert_allclose([theirs[name] for name in take.tree.names], wanted, atol=1e-4)  # float32 of theirs


def test_ends_of_bones_are_where_they_were_told() -> None:
    take = made_take(1)
    leaf = next(i for i in range(9) if i not in take.tree.parents)
    read = parse_bvh(write_bvh(take, {f"joint{leaf}": np.array([1.0, 2.0, 3.0])}), "made.bvh")
    np.testing.assert_allclose(read.offsets[read.joints.index(f"joint{leaf} end")], [1.0, 2.0, 3.0])


@given(st.sampled_from(ORDERS), st.integers(0, 2**32 - 1))
def test_angles_are_the_rotations_and_do_not_jump(order: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles = np.cumsum(rng.uniform(-2.0, 2.0, (200, 1, 3)), axis=0)
    angles[..., 1] = 60.0 * np.sin(np.deg2rad(angles[..., 1]))  # of the middle angle: away from the right angle
    turns = Rotation.from_euler(order, angles[:, 0], degrees=True).as_quat()[:, None]
    found = euler_angles(turns, order)
    assert np.abs(np.diff(found, axis=0)).max() < 10.0
    back = Rotation.from_euler(order, found[:, 0], degrees=True).as_quat()
    assert quaternion.angle_between(back, turns[:, 0]).max() < 1e-6


def test_rotations_of_the_rest_pose_are_refused() -> None:
    take = made_take(2)
    take.tree.rotations[3] = quaternion.about_axis(0, 0.3)
    with pytest.raises(ValueError, match="rest pose"):
        write_bvh(take, {})
