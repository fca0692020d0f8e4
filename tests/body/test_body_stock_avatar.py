"""The stock avatar: a sound VRM 1.0 file, a well-made skin, and a script that writes it again bit for bit."""

import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pygltflib import GLTF2

from elbowroom.body.bones import PARENTS, REQUIRED
from elbowroom.body.stock import stock_avatar_path, stock_fit_path

ROOT = Path(__file__).resolve().parents[2]
SOLID = ("Skin", "Shirt", "Trim", "Trousers", "Shoes", "Soles", "Hair")
_KINDS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TYPES = {5126: np.float32, 5123: np.uint16, 5121: np.uint8}


@cache
def _file() -> Any:
    return GLTF2.load_binary(str(stock_avatar_path()))


def _array(index: int) -> NDArray[Any]:
    accessor = _file().accessors[index]
    view = _file().bufferViews[accessor.bufferView]
    width = _KINDS[accessor.type]
    data = np.frombuffer(
        _file().binary_blob(), _TYPES[accessor.componentType], accessor.count * width, view.byteOffset or 0
    )
    return data.reshape(accessor.count, width)


def _primitives() -> list[Any]:
    return [primitive for mesh in _file().meshes for primitive in mesh.primitives]


def _material(primitive: Any) -> str:
    return str(_file().materials[primitive.material].name)


def _points(primitive: Any) -> NDArray[np.float64]:
    return _array(primitive.attributes.POSITION).astype(np.float64)


def _triangles(primitive: Any) -> NDArray[np.int64]:
    return _array(primitive.indices).astype(np.int64).reshape(-1, 3)


@cache
def _vrm() -> dict[str, Any]:
    extension: dict[str, Any] = _file().extensions["VRMC_vrm"]
    return extension


@cache
def _joints() -> dict[str, NDArray[np.float64]]:
    """World rest positions of the bones."""
    positions: dict[int, NDArray[np.float64]] = {}

    def walk(node: int, origin: NDArray[np.float64]) -> None:
        positions[node] = origin + np.array(_file().nodes[node].translation or [0.0, 0.0, 0.0])
        for child in _file().nodes[node].children or []:
            walk(child, positions[node])

    for root in _file().scenes[0].nodes:
        walk(root, np.zeros(3))
    return {bone: positions[entry["node"]] for bone, entry in _vrm()["humanoid"]["humanBones"].items()}


def _body_points() -> NDArray[np.float64]:
    return np.concatenate([_points(p) for p in _primitives()])


def test_the_file_is_small_and_free() -> None:
    assert stock_avatar_path().stat().st_size < 1_000_000
    meta = _vrm()["meta"]
    assert _vrm()["specVersion"] == "1.0"
    assert meta["authors"] == ["Elbowroom"]
    assert meta["licenseUrl"] == "https://vrm.dev/licenses/1.0/"
    assert meta["otherLicenseUrl"] == "https://creativecommons.org/publicdomain/zero/1.0/"
    assert meta["modification"] == "allowModificationRedistribution"


def test_every_bone_but_the_jaw_is_there_in_its_place() -> None:
    bones = _vrm()["humanoid"]["humanBones"]
    assert set(bones) >= REQUIRED
    assert set(bones) == set(PARENTS) - {"jaw"}
    nodes = _file().nodes
    for bone, parent in PARENTS.items():
        if parent is not None and bone in bones:
            assert bones[bone]["node"] in nodes[bones[parent]["node"]].children
    assert all(node.rotation is None and node.scale is None and node.matrix is None for node in nodes)


def test_it_stands_in_t_pose_on_the_ground_and_faces_front() -> None:
    joints, points = _joints(), _body_points()
    assert joints["hips"][[0, 2]] == pytest.approx([0.0, 0.0])
    assert points[:, 1].min() == pytest.approx(0.0, abs=0.002)
    assert 1.70 < points[:, 1].max() < 1.78
    assert joints["leftHand"][0] > joints["leftLowerArm"][0] > joints["leftUpperArm"][0] > 0
    assert np.ptp([joints[f"left{b}"][1] for b in ("UpperArm", "LowerArm", "Hand")]) < 0.001
    assert joints["leftToes"][2] > joints["leftFoot"][2] + 0.08
    assert joints["leftEye"][2] > joints["head"][2] + 0.04


def test_left_mirrors_right() -> None:
    joints = _joints()
    for bone, place in joints.items():
        if bone.startswith("left"):
            assert joints["right" + bone[4:]] == pytest.approx(place * [-1, 1, 1], abs=1e-6)
    for primitive in _primitives():
        if _material(primitive) in ("Shirt", "Trousers", "Shoes", "Soles"):
            points = _points(primitive)
            assert points.max(axis=0)[0] == pytest.approx(-points.min(axis=0)[0], abs=0.003)


def test_indices_and_weights_are_sound() -> None:
    joint_count = len(_file().skins[0].joints)
    for primitive in _primitives():
        points, triangles = _points(primitive), _triangles(primitive)
        assert set(np.unique(triangles)) == set(range(len(points))), "every point is used, and no other"
        weights = _array(primitive.attributes.WEIGHTS_0).astype(int)
        joints = _array(primitive.attributes.JOINTS_0)
        assert (weights.sum(axis=1) == 255).all()
        assert joints.max() < joint_count
        assert (joints[weights == 0] == 0).all()
        normals = _array(primitive.attributes.NORMAL)
        assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=1e-5)


def _related(a: str, b: str) -> bool:
    """Whether two bones are kin: an ancestor within two steps, or children of one parent (fingers at a web)."""
    above = {name: [name, PARENTS[name], PARENTS.get(PARENTS[name] or "")] for name in (a, b)}
    return a in above[b] or b in above[a] or PARENTS[a] == PARENTS[b]


def test_bones_share_points_only_with_their_neighbours() -> None:
    names = np.array([_file().nodes[j].name for j in _file().skins[0].joints])
    for primitive in _primitives():
        weights = _array(primitive.attributes.WEIGHTS_0)
        joints = np.where(weights > 25, _array(primitive.attributes.JOINTS_0), 255)
        for row in np.unique(joints, axis=0):
            moving = [str(name) for name in names[row[row < 255]]]
            assert all(any(_related(a, b) for b in moving if b != a) for a in moving if len(moving) > 1), moving


def _edges(triangles: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    directed = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    return np.unique(directed, axis=0, return_counts=True)


def test_solids_are_manifold_and_wound_outwards() -> None:
    for primitive in _primitives():
        if _material(primitive) not in SOLID:
            continue
        points, triangles = _points(primitive), _triangles(primitive)
        _, times = _edges(triangles)
        assert (times == 1).all(), "no directed edge twice: manifold, and all triangles wound alike"
        corner = points[triangles]
        face = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        normal = _array(primitive.attributes.NORMAL)[triangles].mean(axis=1)
        agree = (face * normal).sum(axis=1) > 0
        assert agree.mean() > 0.999, _material(primitive)


def _cover_count(point: NDArray[np.float64]) -> int:
    """How many times the solids wind around a point (sum of signed solid angles, Van Oosterom and Strackee 1983)."""
    total = 0.0
    for primitive in _primitives():
        if _material(primitive) in SOLID:
            a, b, c = (_points(primitive)[_triangles(primitive)[:, i]] - point for i in range(3))
            la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
            volume = (a * np.cross(b, c)).sum(axis=1)
            cosine = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
            total += float(np.arctan2(volume, cosine).sum()) / (2.0 * np.pi)
    return round(total)


@pytest.mark.parametrize("bone", sorted(set(PARENTS) - {"jaw", "leftEye", "rightEye"}))
def test_every_joint_lies_inside_the_figure(bone: str) -> None:
    assert _cover_count(_joints()[bone]) >= 1


def test_expressions_and_gaze_point_at_what_is_there() -> None:
    vrm = _vrm()
    nodes, meshes = _file().nodes, _file().meshes
    presets = vrm["expressions"]["preset"]
    assert {"blink", "blinkLeft", "blinkRight", "happy", "aa"} <= set(presets)
    for preset in presets.values():
        for bind in preset.get("morphTargetBinds", []):
            assert bind["index"] < len(meshes[nodes[bind["node"]].mesh].primitives[0].targets)
    assert vrm["lookAt"]["type"] == "bone"
    shown = {annotation["node"] for annotation in vrm["firstPerson"]["meshAnnotations"]}
    assert shown == {i for i, node in enumerate(nodes) if node.mesh is not None}


@pytest.mark.long
def test_the_script_writes_the_same_bytes(tmp_path: Path) -> None:
    out = tmp_path / "stock.vrm"
    environment = {"PYTHONPATH": f"{ROOT / 'tools'}:{ROOT / 'src'}"}
    subprocess.run([sys.executable, "-m", "make_stock_avatar", str(out)], check=True, env=environment)
    assert out.read_bytes() == stock_avatar_path().read_bytes()
    assert out.with_name(stock_fit_path().name).is_file()
