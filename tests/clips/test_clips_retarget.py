"""A motion taken from one body and played on another."""

from dataclasses import replace

import numpy as np
import pytest

from animation_builder import animated_glb, joint_motion
from avatar_builder import MIXAMO, Recipe, build, normalised_fk
from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.body.fitting.proportions import proportional_skeleton
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.body.skeleton import Skeleton
from elbowroom.clips.files import open_motion, parse_motion
from elbowroom.clips.retarget import retarget
from elbowroom.geometry import quaternion
from shared_data import SHARED, needs_shared

RECIPES = {
    "T-pose": Recipe(mesh=False),
    "arms down, turned nodes": Recipe(mesh=False, arms_down=0.9, spin=True, between=True),
    "faces -Z, centimetres": Recipe(mesh=False, heading=np.pi, unit=100.0, root_scale=0.01),
    "Mixamo": Recipe(mesh=False, names=MIXAMO, prefix="mixamorig:", legs_apart=0.2),
}


@pytest.mark.parametrize("name", RECIPES)
def test_an_avatars_own_animation_comes_back(name: str) -> None:
    recipe = RECIPES[name]
    humanoid = load_humanoid_bytes(build(recipe), "made.glb")
    wanted, _ = joint_motion(humanoid, 6)
    clip = parse_motion(animated_glb(recipe), "made.glb").clip("made")
    found = retarget(clip.motion, humanoid.skeleton)
    joints = [j for j, bone in enumerate(humanoid.skeleton.names) if bone in clip.motion.bones]
    away = quaternion.angle_between(found.rotations[:, joints], wanted[:, joints])
    assert away.max() < 2e-5  # of single precision in the file
    assert found.scale == pytest.approx(1.0, abs=0.02)


def test_a_vrm_animation_is_posed_from_its_rest_pose() -> None:
    humanoid = load_humanoid_bytes(build(Recipe(mesh=False)), "made.glb")
    wanted, _ = joint_motion(humanoid, 6)
    clip = parse_motion(animated_glb(vrma=True), "made.vrma").clip()
    assert clip.format == "VRM animation 1.0"
    found = retarget(clip.motion, humanoid.skeleton).rotations
    assert quaternion.angle_between(found, wanted).max() < 2e-5


def test_every_limb_points_where_it_pointed() -> None:
    motion = random_motion(np.random.default_rng(0))
    clip = parse_motion(write_bvh(motion, BvhRecipe()), "made.bvh").clip()
    skeleton = proportional_skeleton(1.2)
    found = retarget(clip.motion, skeleton)
    for bone, tip in (("leftUpperArm", "leftLowerArm"), ("rightLowerLeg", "rightFoot"), ("spine", "chest")):
        for frame in range(len(motion)):
            at, _ = normalised_fk(skeleton, found.rotations[frame])
            along = at[skeleton.index(tip)] - at[skeleton.index(bone)]
            rest = skeleton.positions[skeleton.index(tip)] - skeleton.positions[skeleton.index(bone)]
            wanted = quaternion.rotate(motion.turn(bone)[frame], rest)
            np.testing.assert_allclose(along, wanted, atol=1e-5)


def test_soles_are_as_high_as_they_were() -> None:
    motion = random_motion(np.random.default_rng(1))
    clip = parse_motion(write_bvh(motion, BvhRecipe()), "made.bvh").clip()
    skeleton = proportional_skeleton(2.1)
    found = retarget(clip.motion, skeleton)
    own = replace(clip.motion, bones=skeleton.names, rest=skeleton.positions, hips=found.hips)
    turns = np.stack([normalised_fk(skeleton, pose)[1] for pose in found.rotations])
    own = replace(own, turns=turns, soles=_soles(skeleton))
    wanted = found.scale * clip.motion.sole_points()[..., 1].min(axis=(1, 2))
    np.testing.assert_allclose(own.sole_points()[..., 1].min(axis=(1, 2)), wanted, atol=1e-6)


def _soles(skeleton: Skeleton) -> np.ndarray:
    from elbowroom.body.gait.cycle import gait_shape

    legs = gait_shape(skeleton).legs
    feet = [skeleton.positions[skeleton.index(f"{side}Foot")] for side in ("left", "right")]
    return np.array([[[a[0], 0.0, a[2] - legs[i, 7]], [a[0], 0.0, a[2] + legs[i, 6]]] for i, a in enumerate(feet)])


def test_joints_that_only_one_body_has_share_the_way() -> None:
    motion = random_motion(np.random.default_rng(2))
    few = [
        bone for bone in motion.bones if bone not in ("chest", "upperChest", "neck", "leftShoulder", "rightShoulder")
    ]
    index = [motion.index(bone) for bone in few]
    poor = replace(motion, bones=tuple(few), rest=motion.rest[index], turns=motion.turns[:, index])
    skeleton = Humanoid.default().skeleton
    found = retarget(poor, skeleton)
    turns = np.stack([normalised_fk(skeleton, pose)[1] for pose in found.rotations])
    for bone in ("hips", "leftUpperArm", "rightHand", "leftFoot", "head"):
        assert quaternion.angle_between(turns[:, skeleton.index(bone)], motion.turn(bone)).max() < 1e-6
    spine = motion.turn("spine")
    assert quaternion.angle_between(turns[:, skeleton.index("upperChest")], spine).max() < 1e-6
    part = quaternion.slerp(motion.turn("hips"), spine, np.full(len(motion), 1 / 3))
    assert quaternion.angle_between(turns[:, skeleton.index("spine")], part).max() < 1e-6


@needs_shared
@pytest.mark.parametrize("name", ["cmu_02_02_walk.bvh", "walk01.bvh", "makehuman_walk1.bvh"])
def test_a_walks_feet_stay_on_the_ground(name: str) -> None:
    assert SHARED is not None
    clip = open_motion(SHARED / "motions" / name).clip()
    skeleton = Humanoid.default().skeleton
    found = retarget(clip.motion, skeleton)
    heights = []
    for frame in range(5, len(found), 5):
        at, _ = normalised_fk(skeleton, found.rotations[frame])
        feet = [skeleton.index(f"{side}{bone}") for side in ("left", "right") for bone in ("Foot", "Toes")]
        at = at - at[0] + found.hips[frame]
        heights.append(at[feet, 1].min())
    assert min(heights) > -0.03
    assert np.median(heights) < 0.08
