"""The rig drives the file's nodes so that they stand where the normalised skeleton's joints stand, in any pose."""

import numpy as np
import pytest

from avatar_builder import MIXAMO, UNREAL, Floats, Recipe, build, json_of, normalised_fk, slow_world
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.geometry import quaternion
from odd_bodies import SKELETON
from sampled import sampled
from shared_data import SHARED, needs_shared

RECIPES = {
    "vrm1": Recipe(vrm="1", mesh=False),
    "vrm1-spun": Recipe(vrm="1", spin=True, between=True, seed=1, mesh=False),
    "vrm0": Recipe(vrm="0", heading=np.pi, seed=2, mesh=False),
    "vrm0-spun": Recipe(vrm="0", heading=np.pi, spin=True, between=True, seed=3),
    "mixamo-T": Recipe(names=MIXAMO, prefix="mixamorig:", spin=True, mesh=False),
    "mixamo-A-cm": Recipe(names=MIXAMO, prefix="mixamorig1:", arms_down=0.8, legs_apart=0.15, unit=100.0, spin=True),
    "mixamo-root-scale": Recipe(
        names=MIXAMO, root_scale=0.01, arms_down=0.7, between=True, spin=True, seed=4, mesh=False
    ),
    "unreal-A": Recipe(names=UNREAL, arms_down=0.9, elbows=0.4, legs_apart=0.1, between=True, spin=True, seed=5),
    "unreal-arms-down": Recipe(names=UNREAL, arms_down=1.55, elbows=0.1, spin=True, seed=6, mesh=False),
    "vrm-names-back": Recipe(heading=np.pi, arms_down=0.5, spin=True, seed=7, mesh=False),
    "vrm-names-side": Recipe(heading=-0.5 * np.pi, arms_down=0.5, between=True, spin=True, mesh=False, seed=8),
    "oblique": Recipe(heading=0.7, arms_down=0.5, spin=True, seed=9, mesh=False),
}

LOADABLE = (
    "vrm0/Godette_vrm_v4.vrm",
    "vrm0/Robot.vrm",
    "vrm0/minimal.vrm",
    "vrm0/sphere.vrm",
    "vrm1/VRMC_materials_mtoon_UV_Animation_Test.vrm",
    "vrm1/debug_robot.vrm",
    "vrm1/springbone_collider_capsule_x0p02_r0p1.vrm",
    "glb/CesiumMan.glb",
    "glb/KayKit_Knight.glb",
    "glb/VALID_AIAN_M_1_Casual.glb",
    "glb/m2m_human-male.glb",
    "glb/boxman.glb",
    "glb/m2m_human-zombie.glb",
)


def _driven(humanoid: Humanoid, rotations: Floats, hips: Floats) -> Floats:
    """World matrices of the file's nodes under the rig, by the slow way."""
    rig = humanoid.rig
    assert rig is not None
    assert humanoid.glb is not None
    local = rig.node_rotations(rotations)
    changes = {int(node): {"rotation": local[j]} for j, node in enumerate(rig.nodes)}
    changes[int(rig.nodes[0])]["translation"] = rig.hips_position(hips)
    world: Floats = slow_world(json_of(humanoid.glb), changes)[rig.nodes]
    return world


def _in_root_frame(humanoid: Humanoid, points: Floats) -> Floats:
    rig = humanoid.rig
    assert rig is not None
    c, s = np.cos(rig.facing), np.sin(rig.facing)
    turned: Floats = (points - rig.offset) @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return rig.scale * turned


def _check_poses(humanoid: Humanoid, poses: int, tolerance: float = 1e-6) -> None:
    rng = np.random.default_rng(5)
    skeleton = humanoid.skeleton
    still = np.tile(quaternion.IDENTITY, (len(skeleton.names), 1))
    rest = _driven(humanoid, still, skeleton.positions[0])
    for _ in range(poses):
        rotations = quaternion.from_rotation_vector(rng.normal(0.0, 0.8, (len(skeleton.names), 3)))
        shift = rng.normal(0.0, 0.3, 3)
        world = _driven(humanoid, rotations, skeleton.positions[0] + shift)
        positions, turned = normalised_fk(skeleton, rotations)
        assert np.abs(_in_root_frame(humanoid, world[:, :3, 3]) - positions - shift).max() < tolerance * skeleton.height
        rig = humanoid.rig
        assert rig is not None
        frame = quaternion.to_matrix(quaternion.about_axis(1, rig.facing))
        change = frame.T @ _axes(world) @ _axes(rest).transpose(0, 2, 1) @ frame
        assert np.abs(change - quaternion.to_matrix(turned)).max() < 10.0 * tolerance


def _axes(world: Floats) -> Floats:
    axes: Floats = world[:, :3, :3] / np.linalg.norm(world[:, :3, :3], axis=1, keepdims=True)
    return axes


@pytest.mark.parametrize("recipe", sampled(RECIPES.values(), 5), ids=RECIPES.keys())
def test_nodes_follow_the_normalised_skeleton(recipe: Recipe) -> None:
    _check_poses(load_humanoid_bytes(build(recipe), "made.glb"), 5)


@pytest.mark.parametrize("recipe", RECIPES.values(), ids=RECIPES.keys())
def test_every_rest_pose_becomes_the_same_t_pose(recipe: Recipe) -> None:
    skeleton = load_humanoid_bytes(build(recipe), "made.glb").skeleton
    assert set(skeleton.names) == set(SKELETON.names)
    difference = skeleton.positions - SKELETON.positions[[SKELETON.index(name) for name in skeleton.names]]
    assert np.abs(difference[:, [0, 2]]).max() < 1e-6
    assert np.ptp(difference[:, 1]) < 1e-6  # only the ground is found anew


@needs_shared
@pytest.mark.parametrize("name", sampled(LOADABLE, 6))
def test_real_avatars_follow_the_normalised_skeleton(name: str) -> None:
    assert SHARED is not None
    humanoid = Humanoid.load(SHARED / "avatars" / name)
    skeleton = humanoid.skeleton
    _check_poses(humanoid, 2, tolerance=6e-6)  # their scales differ by as much from axis to axis
    assert 0.5 < skeleton.height < 1.9  # the Knight, whose head is half of it, is 1 m tall
    assert np.allclose(skeleton.positions[0, [0, 2]], 0.0, atol=1e-9)
    assert skeleton.positions[skeleton.index("leftHand"), 0] > 0.15 * skeleton.height
    assert skeleton.positions[skeleton.index("rightHand"), 0] < -0.15 * skeleton.height
    if skeleton.has("leftToes"):
        assert skeleton.positions[skeleton.index("leftToes"), 2] > skeleton.positions[skeleton.index("leftFoot"), 2]


def test_to_file_undoes_to_model() -> None:
    rig = load_humanoid_bytes(build(RECIPES["mixamo-A-cm"]), "made.glb").rig
    assert rig is not None
    points = np.random.default_rng(0).normal(size=(10, 3))
    assert np.allclose(rig.to_model(rig.to_file(points)), points)
