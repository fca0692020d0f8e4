"""X3D and USD that we write: taken apart again, the joints are where they were."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.body.loading.hanim_names import hanim_name
from elbowroom.export.animation import Animation
from elbowroom.export.formats import FORMATS, Wishes
from elbowroom.export.writers import WRITERS
from elbowroom.geometry import quaternion
from made_recording import made_recording

Floats = NDArray[np.float64]
STOCK = Humanoid.default()


@pytest.fixture(scope="module")
def animation(tmp_path_factory: pytest.TempPathFactory) -> Animation:
    made = made_recording(tmp_path_factory.mktemp("made") / "run.elbow", STOCK, 10)
    return Animation.of(made.recording, STOCK)


def written(animation: Animation, ending: str, wishes: Wishes) -> str:
    chosen = FORMATS[ending]
    return WRITERS[ending](animation, STOCK, chosen.layout(wishes)).data.decode()


def numbers(text: str, width: int) -> Floats:
    return np.array(text.split(), float).reshape(-1, width)


def turns_of(axis_angles: Floats) -> Floats:
    return quaternion.from_rotation_vector(axis_angles[:, :3] * axis_angles[:, 3:])


def x3d_places(scene: ET.Element, frames: int) -> dict[str, Floats]:
    """World places (F, 3) of all joints, by the rule of H-Anim: a joint turns about its centre."""
    keys = {node.get("DEF"): node.get("keyValue") or "" for node in scene if node.tag.endswith("Interpolator")}
    found: dict[str, Floats] = {}

    def field(node: ET.Element, name: str, width: int) -> Floats:
        moved = keys.get(f"{node.get('DEF')}_{name}")
        values = numbers(moved or node.get(name) or "0 0 0 0"[: 2 * width - 1], width)
        return values if len(values) == frames else np.tile(values[:1], (frames, 1))  # still ones have one or two

    def visit(node: ET.Element, place: Floats, turn: Floats) -> None:
        center = numbers(node.get("center") or "0 0 0", 3)[0]
        place = place + quaternion.rotate(turn, field(node, "translation", 3) + center)
        turn = quaternion.multiply(turn, turns_of(field(node, "rotation", 4)))
        found[node.get("name") or ""] = place
        for child in node:
            if child.tag == "HAnimJoint" and child.get("USE") is None:
                visit(child, place - quaternion.rotate(turn, center), turn)

    (figure,) = scene.findall("HAnimHumanoid")
    visit(figure, np.zeros((frames, 3)), np.tile(quaternion.IDENTITY, (frames, 1)))
    return found


@pytest.mark.parametrize("root", ["hips", "root"])
def test_an_x3d_figure_moves_as_the_page_shows_it(animation: Animation, root: str) -> None:
    text = written(animation, "x3d", Wishes(root))
    (scene,) = ET.fromstring(text).findall("Scene")
    found = x3d_places(scene, len(animation))
    for joint, bone in enumerate(STOCK.skeleton.names):
        wanted = animation.joints_in_world()[:, joint]
        np.testing.assert_allclose(found[hanim_name(bone)], wanted, atol=1e-6, err_msg=bone)


def test_routes_of_an_x3d_figure_lead_from_and_to_what_is_there(animation: Animation) -> None:
    (scene,) = ET.fromstring(written(animation, "x3d", Wishes())).findall("Scene")
    there = {node.get("DEF") for node in scene.iter() if node.get("DEF")}
    routes = scene.findall("ROUTE")
    assert len(routes) > 20
    assert {route.get(end) for route in routes for end in ("fromNode", "toNode")} <= there
    used = {node.get("USE") for node in scene.iter("HAnimJoint")} - {None}
    assert len(used) == len(STOCK.skeleton.names)
    assert used <= there


def test_an_x3d_figure_is_an_avatar_again(animation: Animation) -> None:
    again = load_humanoid_bytes(written(animation, "x3d", Wishes()).encode(), "again.x3d")
    assert set(again.skeleton.names) == set(STOCK.skeleton.names)
    assert again.skeleton.height == pytest.approx(STOCK.skeleton.height, rel=0.02)


@pytest.mark.parametrize("wishes", [Wishes(), Wishes("root", "a", "cm", "z")])
def test_a_usd_skeleton_moves_as_the_page_shows_it(animation: Animation, wishes: Wishes) -> None:
    text = written(animation, "usda", wishes)
    joints = re.findall(r'"([^"]+)"', re.findall(r"token\[\] joints = \[(.*)\]", text)[0])
    samples = [
        np.array(
            [[float(word) for word in re.findall(r"[-+.\deE]+", part)] for part in re.findall(r"\(([^)]*)\)", row)]
        )
        for row in re.findall(r"^ +\d+: \[(.*)\],$", text, flags=re.MULTILINE)
    ]
    frames = len(animation)
    moved, turned = np.stack(samples[:frames]), np.stack(samples[frames:])[..., [1, 2, 3, 0]]
    places: dict[str, tuple[Floats, Floats]] = {"": (np.zeros((frames, 3)), np.tile(quaternion.IDENTITY, (frames, 1)))}
    for index, joint in enumerate(joints):
        place, turn = places[joint.rpartition("/")[0]]
        here = place + quaternion.rotate(turn, moved[:, index])
        places[joint] = here, quaternion.multiply(turn, turned[:, index])
    unit = float(re.findall(r"metersPerUnit = (\S+)", text)[0])
    for index, bone in enumerate(STOCK.skeleton.names):
        (path,) = [joint for joint in joints if joint.split("/")[-1] == bone]
        found = places[path][0] * unit
        if wishes.up == "z":
            found = np.stack([found[:, 0], found[:, 2], -found[:, 1]], axis=-1)
        np.testing.assert_allclose(found, animation.joints_in_world()[:, index], atol=1e-6, err_msg=bone)
