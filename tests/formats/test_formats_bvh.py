"""The BVH reader: equal to bvhio, and one line with the line's number for whatever is wrong."""

from pathlib import Path

import bvhio
import numpy as np
import pytest

from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.errors import InputError
from elbowroom.formats.bvh import parse_bvh
from sampled import sampled
from shared_data import SHARED, needs_shared

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
GOOD = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Bip01 Spine
  {
    OFFSET 0 10.5 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 1e1 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
1 2 3 0 0 0 0 0 90
1 2 3 90 0 0 -9.23872e-007 0 0
"""


def positions(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """World positions (F, n, 3) of all joints by our reader and by bvhio, at three frames."""
    take = parse_bvh(path.read_bytes(), path.name).take()
    joints = np.array([i for i, name in enumerate(take.tree.names) if not name.endswith(" end")])
    frames = np.unique(np.linspace(0, len(take) - 1, 3).astype(int))
    root = bvhio.readAsHierarchy(str(path))
    theirs = []
    for frame in frames:
        root.loadPose(int(frame))
        theirs.append([list(joint.PositionWorld) for joint, _, _ in root.layout()])
    return take.world(joints)[1][frames], np.array(theirs)


@pytest.mark.parametrize("order", ORDERS)
def test_joint_positions_equal_those_of_bvhio(order: str, tmp_path: Path) -> None:
    motion = random_motion(np.random.default_rng(ORDERS.index(order)), 4)
    path = tmp_path / "made.bvh"
    path.write_bytes(write_bvh(motion, BvhRecipe(order=order, all_positions=order == "XZY")))
    ours, theirs = positions(path)
    assert np.abs(ours - theirs).max() <= 1e-5 * np.ptp(theirs[..., 1])


@needs_shared
@pytest.mark.parametrize(
    "name", sampled(["cmu_02_02_walk", "walk01", "cmu_10_01", "fair1_zombie", "makehuman_walk1"], 2)
)
def test_real_files_equal_bvhio(name: str) -> None:
    assert SHARED is not None
    ours, theirs = positions(SHARED / "motions" / f"{name}.bvh")
    assert np.abs(ours - theirs).max() <= 1e-5 * np.ptp(theirs, axis=1).max()


def test_words_may_stand_in_any_lines_case_and_spacing() -> None:
    take = parse_bvh(GOOD.encode(), "a.bvh").take()
    squeezed = GOOD.replace("\n  ", " ").lower().replace("motion\n", "motion \r\n").replace("frames:", "Frames :")
    remarked = "\ufeff" + GOOD.replace("ROOT", "# made by hand\nROOT").replace("\n", "\r\n")
    for text in (squeezed, remarked):
        other = parse_bvh(text.encode(), "b.bvh").take()
        np.testing.assert_array_equal(other.rotations, take.rotations)
        np.testing.assert_array_equal(other.tree.translations, take.tree.translations)
    assert take.tree.names == ("Hips", "Bip01 Spine", "Bip01 Spine end")
    assert take.fps == 25.0


def test_channels_turn_one_after_the_other_in_degrees() -> None:
    take = parse_bvh(GOOD.encode(), "a.bvh").take()
    _, places = take.world(np.array([0, 1, 2]))
    np.testing.assert_allclose(places[0], np.array([[1, 2, 3], [1, 12.5, 3], [1, 22.5, 3]]), atol=1e-12)
    np.testing.assert_allclose(places[1], np.array([[1, 2, 3], [-9.5, 2, 3], [-19.5, 2, 3]]), atol=1e-6)


def test_a_file_without_frames_is_a_skeleton() -> None:
    text = GOOD[: GOOD.index("Frames")] + "Frames: 0\nFrame Time: 0.04\n"
    assert len(parse_bvh(text.encode(), "a.bvh").take()) == 0


@pytest.mark.parametrize(
    ("old", "new", "line", "said"),
    [
        ("HIERARCHY", "HIERARCHIE X", 1, "HIERARCHY"),
        ("ROOT", "JOINT", 2, "ROOT"),
        ("CHANNELS 6", "CHANNELS 7", 5, "0 to 6"),
        ("CHANNELS 6 Xposition", "CHANNELS 6", 6, "one of 6 channels"),
        ("Xposition", "Wposition", 5, "Xposition to Zrotation"),
        ("Xposition", "Yposition", 5, "does not have yet"),
        ("10.5", "ten", 8, "a number"),
        ("10.5", "nan", 8, "a number"),
        ("Spine\n  {", "Spine\n", 8, "{"),
        ("    }\n  }\n}", "    }\n  }", 14, "brace is not closed"),
        ("}\nMOTION", "}\nROOT B\n{\n}\nMOTION", 16, "one ROOT"),
        ("MOTION", "MOTON", 16, "one ROOT"),
        ("Frames: 2", "Frames: two", 17, "whole number"),
        ("Frames: 2", "Frames: -2", 17, "whole number"),
        ("Frames: 2", "Frames: 3", 17, "Frames: 3, but 2 follow"),
        ("Frames: 2", "Frames: 0", 17, "Frames: 0, but"),
        ("Frames: 2", "Frames: 999999999", 17, "whole number up to"),
        ("Frame Time: 0.04", "Frame Time: 0", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: inf", 18, "seconds"),
        ("Frame Time", "Time", 18, "Frame Time"),
        ("0 0 90\n", "0 0 9O\n", 19, "'9O'"),
        ("0 0 90\n", "0 0 1e9\n", 19, "1e9"),
        ("0 0 90\n", "0 90\n", 19, "8 numbers"),
        ("0 0 90\n", "0 0 0 90\n", 19, "more than 9 numbers"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(old: str, new: str, line: int, said: str) -> None:
    assert old in GOOD
    with pytest.raises(InputError) as error:
        parse_bvh(GOOD.replace(old, new, 1).encode(), "a.bvh")
    message = str(error.value)
    assert message.startswith("a.bvh: line")
    assert f"line {line}:" in message
    assert said in message


def test_a_file_that_ends_before_its_motion_says_so() -> None:
    with pytest.raises(InputError, match=r"a\.bvh: there is no MOTION"):
        parse_bvh(GOOD[: GOOD.index("MOTION")].encode(), "a.bvh")


def test_depth_and_counts_are_bounded() -> None:
    deep = "HIERARCHY\nROOT a {" + "JOINT b {" * 300
    many = "HIERARCHY\nROOT a {" + "End Site { }" * 2100 + "}\n"
    for text, said in ((deep, "deep"), (many, "2000 joints")):
        with pytest.raises(InputError, match=said):
            parse_bvh(f"{text}\nMOTION\nFrames: 1\nFrame Time: 1\n".encode(), "a.bvh")


def test_one_frame_more_than_it_says_is_read() -> None:
    more = parse_bvh(GOOD.replace("Frames: 2", "Frames: 1").encode(), "a.bvh")
    assert np.array_equal(more.values, parse_bvh(GOOD.encode(), "a.bvh").values)
