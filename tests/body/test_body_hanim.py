"""H-Anim humanoids, from strangers' files and made ones: bones, pose, unit, up axis, body, and the GLB they become."""

from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.bones import REQUIRED
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid, load_humanoid_bytes
from elbowroom.body.loading.hanim_names import BY_DEF, BY_NAME
from elbowroom.errors import InputError
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh
from hanim_builder import HanimRecipe, build_hanim
from odd_bodies import SKELETON
from sampled import sampled
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


RECIPES = [
    HanimRecipe("xml", points=4),
    HanimRecipe("classic", skinned=True, points=4, prefix="Joe_", named=False),
    HanimRecipe("vrml", "1.1", points=4, scale=0.0254, arms_down=0.8),
    HanimRecipe("vrml", "2.0", points=4, z_up=True),
    HanimRecipe("xml", "1.1", points=4, bent=0.6, packed=True),
    HanimRecipe("xml", skinned=True, points=4, prefix="hanim_", named=False, arms_down=0.0),
]


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: f"{recipe.encoding} {recipe.version}")
def test_made_figures_come_out_as_the_figure_they_were_made_from(recipe: HanimRecipe) -> None:
    humanoid = load_humanoid_bytes(build_hanim(recipe), "made.wrl")
    skeleton = humanoid.skeleton
    assert set(skeleton.names) == set(SKELETON.names)
    expected = SKELETON.positions[[SKELETON.index(name) for name in skeleton.names]]
    offset = (skeleton.positions - expected).mean(axis=0)
    assert abs(offset[1]) < 0.08  # where the ground is taken to be
    assert np.allclose(skeleton.positions - offset, expected, atol=1e-5)
    assert humanoid.meta.format.startswith(f"H-Anim {recipe.version}")
    how = {source.bone: source.how for source in humanoid.meta.bones}
    assert set(how.values()) == {BY_NAME if recipe.named else BY_DEF}


def test_a_name_that_two_joints_have_gives_way_to_the_def_name() -> None:
    text = build_hanim(HanimRecipe("xml", points=4, prefix="Joe_")).decode()
    wrong = text.replace('name="l_knee"', 'name="l_hip"')
    how = {source.bone: source.how for source in load_humanoid_bytes(wrong.encode(), "a.x3d").meta.bones}
    assert (how["leftUpperLeg"], how["leftLowerLeg"], how["leftFoot"]) == (BY_DEF, BY_DEF, BY_NAME)


@pytest.mark.parametrize(("encoding", "listed"), sampled([("xml", "after"), ("classic", "before"), ("vrml", "after")]))
def test_joints_that_are_listed_once_more_are_one_joint(encoding: str, listed: str) -> None:
    """As many files do: the skeleton lists all its joints by USE, or defines some there that hang elsewhere."""
    recipes = [HanimRecipe(encoding, skinned=True, points=4, listed=where) for where in ("", listed)]
    once, twice = (load_humanoid_bytes(build_hanim(recipe), "made.x3d") for recipe in recipes)
    assert twice.meta.notes == once.meta.notes
    assert twice.meta.notes[0].startswith(f"{len(SKELETON.names)} joints")
    assert np.allclose(twice.skeleton.positions, once.skeleton.positions, atol=1e-6)
    assert twice.glb is not None
    gltf = parse_gltf(twice.glb, "made.glb")
    mesh = triangle_mesh(gltf, read_nodes(gltf))
    assert np.allclose(mesh.weights[:, 0], 1.0)
    skin = mesh.nodes[:, 0]
    assert twice.rig is not None
    assert set(skin) <= set(twice.rig.nodes.tolist())


@pytest.mark.parametrize("scale", ["0 0 0", "1 0 1", "0 1 0"])
def test_a_figure_without_height_is_refused_in_a_line(scale: str) -> None:
    file = build_hanim(HanimRecipe()).decode()
    flat = file.replace('scale="1 1 1"', f'scale="{scale}"', 1)
    assert flat != file
    with pytest.raises(InputError, match="scale") as caught:
        load_humanoid_bytes(flat.encode(), "flat.x3d")
    assert "\n" not in str(caught.value)


def test_level_of_articulation_zero_is_refused_for_what_it_is() -> None:
    text = '#X3D V3.3 utf8\nHAnimHumanoid { skeleton HAnimJoint { name "humanoid_root" center 0 0.8 0 } }'
    with pytest.raises(InputError, match=r"one joint \(level of articulation 0\)"):
        load_humanoid_bytes(text.encode(), "a.x3dv")
