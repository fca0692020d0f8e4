"""What we export we read again: every joint is where it was, within 1e-5 metres, in every format."""

import csv
import io
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.clip import Clip
from elbowroom.clips.files import parse_motion
from elbowroom.export.animation import Animation
from elbowroom.export.formats import FORMATS, Wishes
from elbowroom.export.writers import WRITERS
from elbowroom.formats.bvh import parse_bvh
from elbowroom.geometry import quaternion
from made_recording import made_recording

Floats = NDArray[np.float64]
BODY = Humanoid.default()
EXACT = 1e-5  # metres


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Animation:
    path = tmp_path_factory.mktemp("walked") / "run.elbow"
    return Animation.of(made_recording(path, BODY, 40).recording, BODY, 30.0)


def written(animation: Animation, ending: str, wishes: Wishes) -> bytes:
    chosen = FORMATS[ending]
    return WRITERS[ending](animation, BODY, chosen.layout(wishes)).data


def wanted(animation: Animation, root: str) -> Floats:
    """Places (F, J, 3) of the joints, metres; on the spot where nothing carries the way."""
    joints = animation.joints_in_world()
    if root != "none":
        return joints
    return quaternion.rotate(quaternion.conjugate(animation.turns())[:, None], joints - animation.places[:, None])


def places_of(clip: Clip) -> dict[str, Floats]:
    return {bone: clip.motion.position(bone) for bone in clip.motion.bones}


CLIPS = {
    "glb": Wishes(),
    "vrma": Wishes(),
    "x3d": Wishes(),
    "x3d by its root": Wishes("root"),
    "x3d on the spot": Wishes("none"),
    "usda": Wishes(),
    "usda by its root": Wishes("root"),
    "usda on the spot": Wishes("none"),
    "usda, another unit, axis and rest pose": Wishes("root", "a", "cm", "z"),
}


@pytest.mark.parametrize("way", CLIPS)
def test_a_clip_is_the_motion_that_was_exported(way: str, walked: Animation) -> None:
    ending = way.split(maxsplit=1)[0].rstrip(",")
    clip = parse_motion(written(walked, ending, CLIPS[way]), f"walk.{ending}").clip()
    assert clip.fps == pytest.approx(30.0)
    assert clip.name == walked.name
    joints = wanted(walked, CLIPS[way].root_motion)
    found = places_of(clip)
    assert {"leftHand", "rightToes", "leftIndexDistal", "head"} <= found.keys()
    for bone, place in found.items():
        np.testing.assert_allclose(place, joints[:, BODY.skeleton.index(bone)], atol=EXACT, err_msg=bone)


@pytest.mark.parametrize(
    "wishes", [Wishes(), Wishes("root", "a", "m", "z"), Wishes("none", unit="inch")], ids=["usual", "other", "none"]
)
def test_bvh_holds_the_motion_that_was_exported(wishes: Wishes, walked: Animation) -> None:
    """A BVH file does not say where its ground is: the clip's is found under the soles, so its nodes are looked at."""
    layout = FORMATS["bvh"].layout(wishes)
    take = parse_bvh(written(walked, "bvh", wishes), "walk.bvh").take()
    found = take.world(np.array([take.tree.names.index(name) for name in BODY.skeleton.names]))[1] * layout.unit
    if layout.up == "z":
        found = np.stack([found[..., 0], found[..., 2], -found[..., 1]], axis=-1)
    np.testing.assert_allclose(found, wanted(walked, wishes.root_motion), atol=EXACT)


def test_tables_hold_the_motion_that_was_exported(walked: Animation) -> None:
    joints = walked.joints_in_world()
    with np.load(io.BytesIO(written(walked, "npz", Wishes()))) as archive:
        places = archive["world_positions"][:, [list(archive["names"]).index(name) for name in BODY.skeleton.names]]
    np.testing.assert_allclose(places, joints, atol=EXACT)
    rows = list(csv.DictReader(io.StringIO(written(walked, "csv", Wishes()).decode())))
    for joint, name in enumerate(BODY.skeleton.names):
        table = np.array([[float(row[f"{name}.{axis}"]) for axis in "xyz"] for row in rows])
        np.testing.assert_allclose(table, joints[:, joint], atol=EXACT)


def test_who_stands_turned_to_the_side_is_read_as_turned(tmp_path: Path) -> None:
    """What never changes in a walk is no part of the rest pose."""
    walked = Animation.of(made_recording(tmp_path / "run.elbow", BODY, 30).recording, BODY, 30.0)
    still = Animation(
        walked.name,
        walked.fps,
        walked.skeleton,
        np.repeat(walked.rotations[:1], len(walked), axis=0),
        np.repeat(walked.hips[:1], len(walked), axis=0),
        np.tile([1.0, 0.0, -2.0], (len(walked), 1)),
        np.full(len(walked), 0.7),
    )
    joints = still.joints_in_world()
    for ending, root in (("x3d", "root"), ("x3d", "hips"), ("usda", "root")):
        clip = parse_motion(written(still, ending, Wishes(root)), f"still.{ending}").clip()
        for bone, place in places_of(clip).items():
            stood = np.tile(joints[0, BODY.skeleton.index(bone)], (len(place), 1))
            np.testing.assert_allclose(place, stood, atol=EXACT, err_msg=f"{ending} {root} {bone}")
