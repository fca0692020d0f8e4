"""H-Anim humanoids, from strangers' files and made ones: bones, pose, unit, up axis, body, and the GLB they become."""

from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.bones import REQUIRED
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading import load_humanoid
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from shared_data import SHARED, needs_shared

FILES = sorted(SHARED.glob("avatars/hanim_*/*")) if SHARED else []
HEIGHTS = {  # of the head joint, metres, as the files give it
    "DiamondManLOA-0.wrl": 1.6209,
    "sample1.wrl": 1.34,
    "BoxMan.x3d": 1.64,
    "JoeKick.x3d": 1.64,
    "KoreanCharacter02Chul.x3d": 1.47,
}


@pytest.fixture(scope="module", params=FILES, ids=lambda path: path.name)
def humanoid(request: pytest.FixtureRequest) -> Humanoid:
    return load_humanoid(request.param)


@needs_shared
def test_the_figure_stands_in_t_pose_facing_z(humanoid: Humanoid) -> None:
    skeleton = humanoid.skeleton
    assert set(skeleton.names) >= REQUIRED
    assert skeleton.height == pytest.approx(HEIGHTS[f"{humanoid.name}{Path(str(humanoid.source)).suffix}"], abs=0.01)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        shoulder, elbow, wrist = (
            skeleton.positions[skeleton.index(side + b)] for b in ("UpperArm", "LowerArm", "Hand")
        )
        assert np.allclose((elbow - shoulder)[1:], 0.0, atol=1e-6)
        assert np.allclose((wrist - elbow)[1:], 0.0, atol=1e-6)
        assert sign * elbow[0] > sign * shoulder[0] > 0.0
        assert skeleton.positions[skeleton.index(f"{side}Foot"), 1] < 0.2


@needs_shared
def test_the_glb_carries_the_joints_where_the_skeleton_has_them(humanoid: Humanoid) -> None:
    assert humanoid.glb is not None
    assert humanoid.rig is not None
    tree = read_nodes(parse_gltf(humanoid.glb, "converted.glb"))
    rotations = tree.rotations.copy()
    rotations[humanoid.rig.nodes] = humanoid.rig.node_rotations(
        np.tile([0.0, 0.0, 0.0, 1.0], (len(humanoid.skeleton.names), 1))
    )
    shown = humanoid.rig.to_model(tree.world_matrices(rotations)[humanoid.rig.nodes, :3, 3])
    assert np.allclose(shown, humanoid.skeleton.positions, atol=1e-6)
