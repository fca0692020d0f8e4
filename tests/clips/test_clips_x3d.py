"""Clips of H-Anim figures: what interpolators do is what the joints do, in every encoding, axis and unit."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from elbowroom.clips.files import has_animations, is_motion_only, open_motion, parse_motion
from elbowroom.errors import InputError
from hanim_builder import HanimRecipe, build_hanim, rest_positions
from hanim_mover import CYCLE, Moves, build_moving
from odd_bodies import SKELETON
from shared_data import SHARED, needs_shared

Floats = NDArray[np.float64]
FRAMES = 61

RECIPES = {
    "X3D": HanimRecipe(),
    "X3D Classic": HanimRecipe("classic", prefix="Joe_"),
    "VRML97 with PROTOs": HanimRecipe("vrml", "1.1"),
    "arms half down, saved in another pose": HanimRecipe(arms_down=0.8, bent=0.6),
    "smaller, scaled up": HanimRecipe(scale=2.0),
    "skinned, known by DEF names": HanimRecipe(skinned=True, named=False, prefix="Joe_"),
}


def turning(seed: int, strength: float = 0.5) -> Rotation:
    """A smooth random motion of one joint."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 1.0, FRAMES)[:, None]
    return Rotation.from_rotvec(strength * np.sin(2.0 * np.pi * t * rng.uniform(0.3, 1.0, 3) + rng.uniform(0, 6, 3)))


def axis_angles(turns: Rotation) -> Floats:
    vectors = turns.as_rotvec()
    angles = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.concatenate([vectors / angles, angles], axis=1)


BONES = ("hips", "chest", "head", "leftUpperArm", "rightLowerArm", "leftUpperLeg", "rightLowerLeg")
TURNS = {bone: turning(seed) for seed, bone in enumerate(BONES)}
WAY = np.linspace([0.0, 0.0, 0.0], [0.5, 0.02, 1.0], FRAMES)


def moves(recipe: HanimRecipe) -> Moves:
    turned: Moves = {(bone, "rotation"): axis_angles(turns) for bone, turns in TURNS.items()}
    return {("hips", "translation"): WAY / recipe.scale} | turned


def places(recipe: HanimRecipe) -> dict[str, Floats]:
    """Where every joint is (F, 3), by SciPy."""
    rest, saved = rest_positions(recipe), Rotation.from_rotvec(np.tile([recipe.bent, 0.0, 0.0], (FRAMES, 1)))
    turns, at = {}, {}
    for joint, bone in enumerate(SKELETON.names):
        parent = int(SKELETON.parents[joint])
        own = TURNS.get(bone, saved if bone in ("spine", "leftLowerArm") else Rotation.identity(FRAMES))
        if parent < 0:
            turns[bone], at[bone] = own, rest[0] + WAY
            continue
        above = SKELETON.names[parent]
        turns[bone] = turns[above] * own
        at[bone] = at[above] + turns[above].apply(rest[joint] - rest[parent])
    return at


@pytest.mark.parametrize("name", RECIPES)
def test_interpolators_move_the_joints(name: str) -> None:
    """Elbows that the file saves bent stay bent, as it shows them, where nothing moves them."""
    recipe = RECIPES[name]
    motions = parse_motion(build_moving(recipe, moves(recipe)), "made.x3d")
    assert list(motions.clips) == ["Clock"]
    clip = motions.clip()
    assert clip.fps == pytest.approx((FRAMES - 1) / CYCLE)
    wanted = places(recipe)
    assert {"head", "leftHand", "rightHand", "leftFoot", "rightToes"} <= set(clip.motion.bones)
    for bone in clip.motion.bones:
        np.testing.assert_allclose(clip.motion.position(bone), wanted[bone], atol=1e-5, err_msg=bone)


def test_the_humanoid_itself_may_carry_the_way() -> None:
    """By a route to it; where it is at first is no rest pose."""
    recipe = HanimRecipe()
    turned = Rotation.from_rotvec(np.linspace([0.0, 0.5, 0.0], [0.0, 1.5, 0.0], FRAMES))
    carried: Moves = {("", "translation"): WAY + 1.0, ("", "rotation"): axis_angles(turned)}
    clip = parse_motion(build_moving(recipe, carried), "made.x3d").clip()
    rest = rest_positions(recipe)
    for bone in ("hips", "head", "leftHand", "rightToes"):
        wanted = WAY + 1.0 + turned.apply(rest[SKELETON.index(bone)])
        np.testing.assert_allclose(clip.motion.position(bone), wanted, atol=1e-5, err_msg=bone)


def test_each_clock_is_a_clip() -> None:
    data = build_moving(HanimRecipe(), {("head", "rotation"): axis_angles(TURNS["head"])}).decode()
    more = data[data.index("<TimeSensor") : data.index("</Scene>")]
    for name in ("Clock", "Move0"):
        more = more.replace(f'"{name}"', f'"{name}2"')
    second = more.replace('cycleInterval="2"', 'cycleInterval="1" description="a nod"')
    motions = parse_motion(data.replace("</Scene>", second + "</Scene>").encode(), "made.x3d")
    assert list(motions.clips) == ["Clock", "a nod"]
    assert motions.clip("a nod").motion.duration == pytest.approx(0.5 * motions.clip("Clock").motion.duration)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('cycleInterval="2"', 'cycleInterval="0"', r"line \d+: TimeSensor Clock.cycleInterval must be more than 0"),
        ('key="0 ', 'key="0.5 ', "key must be numbers that go up"),
        ('key="0 ', 'key="0 0 ', "keyValue must be 62 values, one for each key, not 61"),
        ("fraction_changed", "time", "holds no interpolators"),
        ("set_rotation", "set_centre", "holds no interpolators"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(old: str, new: str, said: str) -> None:
    data = build_moving(HanimRecipe(), {("head", "rotation"): axis_angles(TURNS["head"])})
    assert old.encode() in data
    with pytest.raises(InputError, match=said):
        parse_motion(data.replace(old.encode(), new.encode()), "made.x3d").clip()


def test_a_figure_that_moves_is_an_avatar_with_a_motion() -> None:
    still, moving = build_hanim(HanimRecipe()), build_moving(HanimRecipe(), moves(HanimRecipe()))
    assert not is_motion_only(moving, "a.x3d")
    assert has_animations(moving, "a.x3d")
    assert not has_animations(still, "a.x3d")


@needs_shared
def test_a_kick_from_the_web3d_consortium() -> None:
    assert SHARED is not None
    clip = open_motion(SHARED / "avatars" / "hanim_x3d" / "JoeKick.x3d").clip("KickTimer")
    assert clip.motion.duration == pytest.approx(3.73, abs=0.02)
    assert 1.5 < clip.figure.height < 1.75
    feet = [clip.motion.position(f"{side}Foot") for side in ("left", "right")]
    assert max(foot[:, 1].max() for foot in feet) > 0.6
