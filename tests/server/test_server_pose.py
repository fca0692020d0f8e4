"""What a client sets on an avatar's nodes puts its joints where the planner believes them."""

from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL_GROUPS, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, hips_position, local_rotations
from elbowroom.body.stock import stock_avatar_path
from elbowroom.formats.gltf import read_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.geometry import quaternion
from elbowroom.server.schema.picture import Placement
from elbowroom.server.wire.pose import Poser, placement
from sampled import sampled
from shared_data import SHARED, needs_shared

FILES = [
    "vrm0/Godette_vrm_v4.vrm",
    "vrm0/Robot.vrm",
    "vrm1/debug_robot.vrm",
    "glb/m2m_human-male.glb",
    "glb/VALID_AIAN_M_1_Casual.glb",
]


def random_posture(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    root = np.array([*rng.normal(size=2), rng.uniform(-4, 4), rng.uniform(0, 1.5), 0.0, 0.0, rng.uniform(0, 3)])
    local = [rng.uniform(*limits(group).T) for group in LOCAL_GROUPS]
    return np.concatenate([root[:3], *local]), root


def joints_in_root_frame(humanoid: Humanoid, q: np.ndarray, root: np.ndarray) -> np.ndarray:
    """Naive forward kinematics of the normalised skeleton."""
    skeleton, model = humanoid.skeleton, body_model(humanoid)
    turns = local_rotations(model, q, root)
    places, world = [hips_position(model, q, root)], [turns[0]]
    for joint in range(1, len(skeleton.names)):
        parent = int(skeleton.parents[joint])
        offset = skeleton.positions[joint] - skeleton.positions[parent]
        places.append(places[parent] + quaternion.rotate(world[parent], offset))
        world.append(quaternion.multiply(world[parent], turns[joint]))
    return np.array(places)


def joints_of_the_drawn_file(path: Path, humanoid: Humanoid, q: np.ndarray, root: np.ndarray) -> np.ndarray:
    """What the page does: set the nodes, place the file's scene in the root's frame."""
    assert humanoid.rig is not None
    tree, posed, placed = read_nodes(read_gltf(path)), Poser(humanoid).node_pose(q, root), placement(humanoid.rig)
    nodes = humanoid.rig.nodes
    rotations = tree.rotations.copy()
    rotations[nodes] = posed.rotations
    tree.translations[nodes[0]] = posed.hips
    in_file = tree.world_matrices(rotations)[nodes, :3, 3]
    return placed_points(placed, in_file)


def placed_points(placed: Placement, points: np.ndarray) -> np.ndarray:
    turned = quaternion.rotate(quaternion.about_axis(1, placed.heading), placed.scale * points)
    return np.add(turned, placed.position)


def check(path: Path) -> None:
    humanoid, rng = Humanoid.load(path), np.random.default_rng(3)
    for _ in range(4):
        q, root = random_posture(rng)
        drawn = joints_of_the_drawn_file(path, humanoid, q, root)
        np.testing.assert_allclose(drawn, joints_in_root_frame(humanoid, q, root), atol=2e-4)


def test_the_stock_avatar_is_drawn_where_it_is_planned() -> None:
    check(stock_avatar_path())


@needs_shared
@pytest.mark.parametrize("name", sampled(FILES, 2))
def test_real_avatars_are_drawn_where_they_are_planned(name: str) -> None:
    assert SHARED is not None
    check(SHARED / "avatars" / name)


def test_the_tables_do_what_the_rig_says() -> None:
    humanoid = Humanoid.default()
    assert humanoid.rig is not None
    q, root = random_posture(np.random.default_rng(1))
    poser = Poser(humanoid)
    expected = humanoid.rig.node_rotations(local_rotations(poser.model, q, root))
    np.testing.assert_allclose(poser.node_pose(q, root).rotations, expected, atol=1e-6)


def test_a_humanoid_without_a_file_is_posed_by_its_skeleton() -> None:
    humanoid = proportional_humanoid(1.72)
    poser = Poser(humanoid)
    q, root = random_posture(np.random.default_rng(2))
    posed = poser.node_pose(q, root)
    np.testing.assert_allclose(posed.rotations, local_rotations(poser.model, q, root), atol=1e-6)
    np.testing.assert_allclose(posed.hips, hips_position(poser.model, q, root))
    assert placement(None) == Placement((0.0, 0.0, 0.0), 0.0, 1.0)
