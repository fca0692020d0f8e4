"""Unit, up axis, facing and rest pose of motion files are recognised, and the same motion comes out of all of them."""

import json
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from avatar_builder import Recipe, build
from bvh_builder import BONES, BvhRecipe, random_motion, write_bvh
from elbowroom.body.dof import DofGroup
from elbowroom.clips.body_motion import BodyMotion, joint_chain
from elbowroom.clips.files import open_motion, parse_motion
from elbowroom.clips.told import Told
from elbowroom.errors import InputError
from elbowroom.geometry import quaternion
from odd_bodies import SKELETON
from shared_data import SHARED, needs_shared

Y_UP = quaternion.IDENTITY
Z_UP = quaternion.about_axis(0, 0.5 * np.pi)
X_UP = quaternion.about_axis(2, -0.5 * np.pi)
UPS = {"y": Y_UP, "z": Z_UP, "x": X_UP, "-y": quaternion.about_axis(0, np.pi)}
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "cmu": 0.0254 / 0.45, "dm": 0.1}


@pytest.mark.parametrize(
    ("up", "unit"), [*product(UPS, ["cm"]), *product("y", [name for name in UNITS if name != "cm"]), ("z", "inch")]
)
def test_the_same_motion_comes_out_of_any_axes_and_unit(up: str, unit: str) -> None:
    rng = np.random.default_rng(len(up) + len(unit))
    motion = random_motion(rng)
    turned = quaternion.multiply(UPS[up], quaternion.about_axis(1, 0.5 * np.pi * rng.integers(4)))
    recipe = BvhRecipe(unit=UNITS[unit], to_file=tuple(turned), arms_down=float(rng.choice([0.0, 0.8, 1.5])))
    clip = parse_motion(write_bvh(motion, recipe), "made.bvh").clip()
    assert (clip.figure.up, clip.figure.unit_name) == (up, unit)
    # the facing of the file's world is free: all frames may be turned by one angle about the vertical
    read = clip.motion.turns[:, [clip.motion.index(bone) for bone in motion.bones]]
    world = quaternion.multiply(read[:, :1], quaternion.conjugate(motion.turns[:, :1]))
    same = quaternion.multiply(quaternion.conjugate(world), read)
    angles = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(same), motion.turns))
    assert np.abs(angles).max() < 1e-6
    assert np.ptp(np.abs(world[..., 1])) < 1e-6
    assert np.abs(world[..., [0, 2]]).max() < 1e-6


def test_arms_that_hang_in_the_rest_pose_are_the_same_as_stretched_ones() -> None:
    motion = random_motion(np.random.default_rng(5))
    clips = [
        parse_motion(write_bvh(motion, BvhRecipe(arms_down=down)), "a.bvh").clip() for down in (0.0, 0.7, 0.5 * np.pi)
    ]
    for clip in clips[1:]:
        np.testing.assert_allclose(clip.motion.turns, clips[0].motion.turns, atol=1e-6)
        np.testing.assert_allclose(clip.motion.hips, clips[0].motion.hips, atol=1e-6)


def test_what_is_told_is_not_guessed() -> None:
    data = write_bvh(random_motion(np.random.default_rng(6)), BvhRecipe())
    told = parse_motion(data, "a.bvh", Told(unit="inch", up="z", fps=60.0)).clip()
    assert told.figure.unit == 0.0254
    assert told.figure.up == "z"
    assert told.fps == pytest.approx(60.0)


@pytest.mark.parametrize(
    ("told", "said"),
    [({"unit": "furlong"}, "furlong"), ({"unit": "-1"}, "-1"), ({"up": "w"}, "axis"), ({"fps": 0.0}, "fps")],
)
def test_nonsense_that_is_told_is_refused(told: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Told(**told)  # type: ignore[arg-type]


RECOGNISED = {
    # file: up, unit, frames a second, frames; the head joint 1.2 to 1.75 m above the ground follows from the unit
    "fair1_zombie.bvh": ("z", "body", 30.0, 779),
    "fair1_jumping.bvh": ("z", "body", 119.88, 654),
    "fair1_wave_hello.bvh": ("z", "body", 119.88, 839),
    "walk01.bvh": ("y", "cm", 24.0, 101),
    "three-vrm_test.vrma": ("y", "m", 60.0, 181),
}


@needs_shared
@pytest.mark.parametrize("name", RECOGNISED)
def test_real_files_are_recognised(name: str) -> None:
    assert SHARED is not None
    clip = open_motion(SHARED / "motions" / name).clip()
    found = (clip.figure.up, clip.figure.unit_name, round(clip.fps, 2), len(clip.motion))
    assert found == RECOGNISED[name]
    assert 1.2 <= clip.figure.height <= 1.75


@needs_shared
def test_all_clips_of_a_library_are_read() -> None:
    assert SHARED is not None
    library = open_motion(SHARED / "motions" / "m2m_human-base-animations.glb")
    assert len(library.clips) == 44
    crouch = library.clip("Crouch_Fwd_Loop")
    assert crouch.motion.hips[:, 1].max() < 0.6 * crouch.figure.hips_height
    with pytest.raises(InputError, match="holds no clip 'Crouch'"):
        library.clip("Crouch")
    with pytest.raises(InputError, match="44 clips"):
        library.clip()


@needs_shared
@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("malformed-channel-count", "line 6"),
        ("malformed-frame-count", "but 2 follow"),
        ("malformed-missing-hierarchy", "HIERARCHY"),
        ("malformed-no-motion", "no MOTION"),
        ("malformed-unclosed-joint", "brace is not closed"),
        ("valid-empty-motion", "no frames"),
        ("valid-minimal-root", "no skeleton of a humanoid"),
    ],
)
def test_fixtures_are_refused_for_the_true_reason(name: str, said: str) -> None:
    assert SHARED is not None
    with pytest.raises(InputError, match=said):
        open_motion(SHARED / "motions" / "bvh_fixtures" / f"{name}.bvh").clip()


def test_files_that_hold_no_motion_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="neither BVH"):
        parse_motion(b"MZ\x90 not a motion", "a.bvh")
    with pytest.raises(InputError, match="cannot be read"):
        open_motion(tmp_path / "missing.bvh")


def _marching(frames: int = 120, fps: float = 30.0) -> BodyMotion:
    """A figure that lifts its feet in turn, one stride a second, and swings its arms."""
    time = np.arange(frames) / fps
    local = np.tile(quaternion.IDENTITY, (frames, len(BONES), 1))
    for side, begin in (("left", 0.0), ("right", 0.5)):
        swing = np.sin(2.0 * np.pi * (time + begin))
        for part, angles in (("UpperLeg", -0.6), ("LowerLeg", 1.2)):
            local[:, BONES.index(side + part)] = quaternion.about_axis(0, angles * np.maximum(swing, 0.0))
        hang = quaternion.about_axis(2, -1.4 if side == "left" else 1.4)
        local[:, BONES.index(f"{side}UpperArm")] = quaternion.multiply(quaternion.about_axis(0, -0.3 * swing), hang)
    turns = local.copy()
    for i, bone in enumerate(BONES[1:], start=1):
        above = BONES.index(joint_chain(BONES, bone)[-2])
        turns[:, i] = quaternion.multiply(turns[:, above], local[:, i])
    rest = SKELETON.positions[[SKELETON.index(bone) for bone in BONES]]
    return BodyMotion("march", BONES, rest, 1.0 / fps, turns, np.tile(rest[0], (frames, 1)), np.zeros((2, 2, 3)))


def test_marching_on_the_spot_is_a_walk() -> None:
    clip = parse_motion(write_bvh(_marching(), BvhRecipe()), "march.bvh").clip()
    strides = clip.planning.track.strides
    assert strides.on_the_spot
    assert 0.8 < strides.speed < 2.0
    assert np.diff([frame for _, frame in strides.strikes]) == pytest.approx(15.0, abs=1.0)
    assert np.ptp(clip.swing.goal(DofGroup.LEFT_ARM, np.linspace(0.0, 1.0, 20), np.full(20, strides.speed))[:, 0]) > 0.3


def test_a_jump_with_both_feet_is_no_walk() -> None:
    motion = _marching()
    for part in ("UpperLeg", "LowerLeg", "Foot", "Toes"):
        left, right = (BONES.index(side + part) for side in ("left", "right") if side + part in BONES)
        motion.turns[:, right] = motion.turns[:, left]
    strides = parse_motion(write_bvh(motion, BvhRecipe()), "jump.bvh").clip().planning.track.strides
    assert not strides.walks


def test_bones_are_taken_from_the_file_beside(tmp_path: Path) -> None:
    odd = {name: f"part{number}" for number, name in enumerate(BONES)}
    path = tmp_path / "odd.bvh"
    path.write_bytes(write_bvh(random_motion(np.random.default_rng(3)), BvhRecipe(names=odd)))
    swapped = {bone: odd[bone] for bone in BONES} | {"leftLowerArm": odd["leftHand"], "leftHand": odd["leftLowerArm"]}
    (tmp_path / "odd.bvh.bones.json").write_text(json.dumps(swapped))
    with pytest.raises(InputError, match=r"leftHand .* must hang below"):
        open_motion(path).clip()
    (tmp_path / "odd.bvh.bones.json").write_text(json.dumps({bone: odd[bone] for bone in BONES}))
    clip = open_motion(path).clip()
    assert clip.figure.bones == {bone: clip.figure.bones[bone] for bone in BONES}
    without = tmp_path / "glb" / "a.glb"
    without.parent.mkdir()
    without.write_bytes(build(Recipe(names=dict.fromkeys(BONES, "x"), mesh=False)))
    with pytest.raises(InputError, match="holds no animation"):
        open_motion(without)


def test_what_is_no_motion_is_said_plainly() -> None:
    for data, words in (
        (b"", "is empty"),
        (b"\x00\x01\x02\x03", "begins with the bytes 00 01 02 03"),
        (b"<html>", "is an XML file: it is neither BVH"),
    ):
        with pytest.raises(InputError, match=words):
            parse_motion(data, "a.bvh")
