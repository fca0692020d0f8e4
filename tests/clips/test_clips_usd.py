"""Clips of USD: joints, the prims above them, unit, axis and rate are those of the stage; what is wrong is told."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.files import is_motion_only, parse_motion
from elbowroom.errors import InputError
from elbowroom.export.animation import Animation
from elbowroom.export.formats import FORMATS, Wishes
from elbowroom.export.writers import WRITERS
from elbowroom.formats.usd.prims import parse_usda
from elbowroom.formats.usd.skel import usd_skeletons, usd_take
from made_recording import made_recording

Floats = NDArray[np.float64]
BODY = Humanoid.default()
PRIM = 'def Skeleton "skeleton"'


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Animation:
    path = tmp_path_factory.mktemp("walked") / "run.elbow"
    return Animation.of(made_recording(path, BODY, 24).recording, BODY, 24.0)


@pytest.fixture(scope="module")
def text(walked: Animation) -> str:
    return WRITERS["usda"](walked, BODY, FORMATS["usda"].layout(Wishes())).data.decode()


def place(text: str, bone: str) -> Floats:
    return parse_motion(text.encode(), "made.usda").clip().motion.position(bone)


def within(text: str, operations: str, order: str) -> str:
    """The skeleton in an Xform with these operations."""
    start, end = text.index(PRIM), text.index('def Mesh "bones"')
    xform = f'def Xform "placed"\n{{\n{operations}\nuniform token[] xformOpOrder = [{order}]\n'
    inside = text[start:end].replace("</avatar/skeleton/animation>", "</avatar/placed/skeleton/animation>")
    return text[:start] + xform + inside + "}\n" + text[end:]


def test_the_prims_above_place_the_skeleton(text: str, walked: Animation) -> None:
    """The first operation of the order is the outermost; `rotateZYX` turns about Z first."""
    operations = """
        double3 xformOp:translate = (1, 0, -2)
        float3 xformOp:rotateZYX = (4, 30, 3)
        double3 xformOp:translate:pivot = (0.5, 0, 0)
        float3 xformOp:scale = (0.9, 0.9, 0.9)  # a smaller figure
        quatf xformOp:orient = (0.9238795, 0, 0.3826834, 0)"""
    order = (
        '"xformOp:translate", "xformOp:translate:pivot", "xformOp:rotateZYX", "xformOp:orient", "xformOp:scale", '
        '"!invert!xformOp:translate:pivot"'
    )
    turn = Rotation.from_euler("zyx", [3, 30, 4], degrees=True) * Rotation.from_quat([0, 0.3826834, 0, 0.9238795])
    skeleton = usd_skeletons(parse_usda(within(text, operations, order).encode(), "made.usda"))[0]
    take = usd_take(skeleton, "made.usda")
    for bone in ("hips", "head", "rightToes"):
        inner = walked.joints_in_world()[:, BODY.skeleton.index(bone)]
        world = turn.apply(0.9 * (inner - [0.5, 0, 0])) + np.array([1.5, 0, -2])
        found = take.world(np.array([take.tree.names.index(bone)]))[1][:, 0]
        np.testing.assert_allclose(found, world, atol=1e-5)


def test_what_the_prims_above_do_in_time_moves_the_figure(text: str, walked: Animation) -> None:
    keys = ", ".join(f"{frame}: ({0.1 * frame}, 0, 0)" for frame in range(len(walked)))
    moving = within(text, f"double3 xformOp:translate.timeSamples = {{ {keys} }}", '"xformOp:translate"')
    way = np.outer(0.1 * np.arange(len(walked)), [1.0, 0.0, 0.0])
    for bone in ("hips", "leftHand"):
        np.testing.assert_allclose(place(moving, bone), place(text, bone) + way, atol=1e-5)


def test_joints_may_stand_in_another_order_and_be_missing_in_the_animation(text: str) -> None:
    """What is not animated stays as in the rest pose: here all but the hips."""
    start = text.index("def SkelAnimation")
    first = text.index("uniform token[] joints", start)
    lines = text[first:].splitlines()
    lines[0] = 'uniform token[] joints = ["hips/none", "hips"]'
    kept = []
    for line in lines:
        head, bracket, rest = line.partition("[(")
        if bracket and head.strip().rstrip(":").isdigit():
            one = rest.split(")", 1)[0]
            kept.append(f"{head}[({', '.join(['1'] + ['0'] * one.count(','))}), ({one})],")
        else:
            kept.append(line)
    fewer = text[:first] + "\n".join(kept)
    clip = parse_motion(fewer.encode(), "made.usda").clip()
    np.testing.assert_allclose(clip.motion.position("hips"), place(text, "hips"), atol=1e-9)
    joints = {bone: clip.motion.position(bone) for bone in ("hips", "leftHand", "rightFoot")}
    far = [np.linalg.norm(joints[bone] - joints["hips"], axis=1) for bone in ("leftHand", "rightFoot")]
    assert np.ptp(far, axis=1).max() < 1e-6


def test_rate_and_first_time_code_are_those_of_the_stage(text: str, walked: Animation) -> None:
    slower = text.replace("timeCodesPerSecond = 24", "timeCodesPerSecond = 30")
    assert parse_motion(slower.encode(), "a.usda").clip().fps == pytest.approx(30.0)
    frames = range(len(walked))
    later = text
    for frame in reversed(frames):
        later = later.replace(f"            {frame}: [", f"            {frame + 101}: [")
    np.testing.assert_allclose(place(later, "head"), place(text, "head"), atol=1e-9)


WRONG: dict[str, tuple[Callable[[str], str], str]] = {
    "binary": (lambda text: "PXR-USDC" + text[8:], "USD in its binary form: save it as text"),
    "cut": (lambda text: text[: len(text) // 2], r"line \d+: "),
    "no skeleton": (lambda text: text.replace("Skeleton", "Scope"), "holds no SkelAnimation of a Skeleton"),
    "too few": (lambda text: text.replace("            3: [(", "            3: [(0, 0, 0), ("), "one for each joint"),
    "shear": (lambda text: within(text, "double3 xformOp:scale = (1, -1, 1)", '"xformOp:scale"'), "mirrors"),
    "unknown": (lambda text: within(text, "", '"xformOp:bend"'), "'xformOp:bend' is no operation that is known"),
    "nothing told": (lambda text: within(text, "", '"xformOp:translate"'), "translate must have 3 numbers"),
    "huge": (lambda text: text.replace("[(0, ", "[(1e30, ", 1), "finite"),
    "no axis": (lambda text: text.replace('upAxis = "Y"', 'upAxis = "W"'), "upAxis 'W'"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_said_in_one_line(name: str, text: str) -> None:
    change, said = WRONG[name]
    assert change(text) != text
    with pytest.raises(InputError, match=said) as caught:
        parse_motion(change(text).encode(), "made.usda").clip()
    assert "\n" not in str(caught.value)
    assert "made.usda" in str(caught.value)


def test_strings_comments_and_what_is_passed_by_are_no_stumbling_blocks(text: str, walked: Animation) -> None:
    noise = '''
    /* a } comment */ custom string note = """three ( lines
    of "quoted" } text""" (doc = 'it )')
    custom dictionary all = { string a = "}" dictionary b = { int[] c = [1, 2] } }
    asset picture = @a(1).png@
    variantSet "looks" = { "red" { def Scope "x" {} } }
    rel target = [</a>, </b>]
    prepend rel other = None  # }
    '''
    data = text.replace("    uniform token[] joints", noise + "    uniform token[] joints", 1)
    data = data.replace(
        "(\n    defaultPrim", '(\n    "a comment" subLayers = [@b.usda@ (offset = 1)]\n    defaultPrim', 1
    )
    np.testing.assert_allclose(place(data, "head"), place(text, "head"), atol=1e-12)


def test_usd_is_no_avatar(text: str, tmp_path: Path) -> None:
    assert is_motion_only(text.encode(), "a.usda")
    assert not is_motion_only(b"PXR-USDC...", "a.usdc")  # as far as can be told: it may be a place
