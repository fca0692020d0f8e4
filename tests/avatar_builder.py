"""Avatar files made on the spot: any bone names, rest pose, rest rotations, nodes between bones, unit and facing."""

import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.formats.packing import write_glb
from elbowroom.geometry import quaternion
from odd_bodies import SKELETON, Body

Floats = NDArray[np.float64]

MIXAMO = {
    "hips": "Hips",
    "spine": "Spine",
    "chest": "Spine1",
    "upperChest": "Spine2",
    "neck": "Neck",
    "head": "Head",
}
UNREAL = {
    "hips": "pelvis",
    "spine": "spine_01",
    "chest": "spine_02",
    "upperChest": "spine_03",
    "neck": "neck_01",
    "head": "head",
}
_LIMB_NAMES = {
    "Shoulder": ("Shoulder", "clavicle"),
    "UpperArm": ("Arm", "upperarm"),
    "LowerArm": ("ForeArm", "lowerarm"),
    "Hand": ("Hand", "hand"),
    "UpperLeg": ("UpLeg", "thigh"),
    "LowerLeg": ("Leg", "calf"),
    "Foot": ("Foot", "foot"),
    "Toes": ("ToeBase", "ball"),
}
for _side in ("left", "right"):
    for _bone, (_mixamo, _unreal) in _LIMB_NAMES.items():
        MIXAMO[_side + _bone] = _side.capitalize() + _mixamo
        UNREAL[_side + _bone] = f"{_unreal}_{_side[0]}"


@dataclass(frozen=True)
class Recipe:
    """What the avatar file is to be like."""

    vrm: str = ""  # "", "0" or "1"
    names: dict[str, str] = field(default_factory=dict)  # bone -> node name; bone names where empty
    prefix: str = ""
    arms_down: float = 0.0  # rest pose: upper arms below the horizontal, radians
    elbows: float = 0.0  # rest pose: forearms bent forward, radians
    legs_apart: float = 0.0  # rest pose, radians; the feet stay level
    spin: bool = False  # random rest rotations
    between: bool = False  # other nodes between the bones
    heading: float = 0.0  # of the model in its file
    unit: float = 1.0  # file units per metre in world space
    root_scale: float = 1.0  # scale of the node above the hips
    mesh: bool = True
    points: int = 21  # of the mesh, round each bone: three for each triangle
    body: Body | None = None  # instead of such points; for rest poses that are the T-pose
    seed: int = 0


def build(recipe: Recipe) -> bytes:
    """A GLB after the recipe; its figure is `SKELETON`."""
    rng = np.random.default_rng(recipe.seed)
    positions, turns = _rest_pose(SKELETON, recipe)
    frame = quaternion.about_axis(1, recipe.heading)
    nodes: list[dict[str, Any]] = [{"name": "root", "scale": [recipe.root_scale] * 3, "translation": [0.3, 0.2, -0.1]}]
    worlds = [(np.array([0.3, 0.2, -0.1]), quaternion.IDENTITY, recipe.root_scale)]
    carrier: dict[int, int] = {}
    for joint, bone in enumerate(SKELETON.names):
        parent = carrier[int(SKELETON.parents[joint])] if joint else 0
        world = recipe.unit * quaternion.rotate(frame, positions[joint])
        if recipe.between and joint % 2:
            extra = world + 0.05 * recipe.unit * rng.normal(size=3)
            parent = _add(nodes, worlds, f"extra{joint}", parent, extra, _random(rng))
        spin = _random(rng) if recipe.spin else quaternion.IDENTITY
        rotation = quaternion.multiply(quaternion.multiply(frame, turns[joint]), spin)
        name = recipe.prefix + recipe.names.get(bone, bone)
        carrier[joint] = _add(nodes, worlds, name, parent, world, rotation)
    content: dict[str, Any] = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes}
    binary = _add_mesh(content, worlds, carrier, recipe) if recipe.mesh else b""
    _add_vrm(content, carrier, recipe.vrm)
    return write_glb(content, binary)


def _random(rng: np.random.Generator) -> Floats:
    return quaternion.normalize(rng.normal(size=4))


def _rest_pose(skeleton: Skeleton, recipe: Recipe) -> tuple[Floats, Floats]:
    local = np.tile(quaternion.IDENTITY, (len(skeleton.names), 1))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        local[skeleton.index(f"{side}UpperArm")] = quaternion.about_axis(2, -sign * recipe.arms_down)
        local[skeleton.index(f"{side}LowerArm")] = quaternion.about_axis(1, -sign * recipe.elbows)
        local[skeleton.index(f"{side}UpperLeg")] = quaternion.about_axis(2, sign * recipe.legs_apart)
        local[skeleton.index(f"{side}Foot")] = quaternion.about_axis(2, -sign * recipe.legs_apart)
    return normalised_fk(skeleton, local)


def normalised_fk(skeleton: Skeleton, local: Floats) -> tuple[Floats, Floats]:
    """Positions (J, 3) and world rotations (J, 4) of the normalised skeleton, joint by joint."""
    positions, world = skeleton.positions.copy(), local.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            world[joint] = quaternion.multiply(world[parent], local[joint])
            bone = skeleton.positions[joint] - skeleton.positions[parent]
            positions[joint] = positions[parent] + quaternion.rotate(world[parent], bone)
    return positions, world


def _add(
    nodes: list[dict[str, Any]],
    worlds: list[tuple[Floats, Floats, float]],
    name: str,
    parent: int,
    position: Floats,
    rotation: Floats,
) -> int:
    at, turn, scale = worlds[parent]
    inverse = quaternion.conjugate(turn)
    translation = quaternion.rotate(inverse, position - at) / scale
    local = quaternion.multiply(inverse, rotation)
    nodes.append({"name": name, "translation": translation.tolist(), "rotation": local.tolist()})
    nodes[parent].setdefault("children", []).append(len(nodes) - 1)
    worlds.append((position, rotation, scale))
    return len(nodes) - 1


def _add_mesh(
    content: dict[str, Any], worlds: list[tuple[Floats, Floats, float]], carrier: dict[int, int], recipe: Recipe
) -> bytes:
    """A skinned mesh: the recipe's body, or triangles round each bone, each wholly its own."""
    rng = np.random.default_rng(1)
    binds = []
    for node in carrier.values():
        at, turn, scale = worlds[node]
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = scale * quaternion.to_matrix(turn), at
        binds.append(np.linalg.inv(matrix).T)
    if recipe.body is None:
        clouds = [_cloud(rng, worlds, carrier, joint, recipe) for joint in carrier]
        points, slots = np.concatenate(clouds), np.repeat(list(carrier), recipe.points)
        indices = None
    else:
        points = recipe.unit * quaternion.rotate(quaternion.about_axis(1, recipe.heading), recipe.body.points)
        slots = np.array([SKELETON.index(bone) for bone in recipe.body.bones])
        indices = recipe.body.triangles.ravel()
    positions, joints = points.astype("<f4"), np.zeros((len(points), 4), "<u2")
    joints[:, 0] = slots
    weights = np.tile(np.array([255, 0, 0, 0], "<u1"), (len(joints), 1))
    arrays = [positions, joints, weights, np.array(binds, "<f4")]
    arrays += [] if indices is None else [indices.astype("<u4")]
    views, start = [], 0
    for array in arrays:
        views.append({"buffer": 0, "byteOffset": start, "byteLength": array.nbytes})
        start += array.nbytes
    accessors: list[dict[str, Any]] = [
        {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": len(joints), "type": "VEC4"},
        {"bufferView": 2, "componentType": 5121, "normalized": True, "count": len(weights), "type": "VEC4"},
        {"bufferView": 3, "componentType": 5126, "count": len(binds), "type": "MAT4"},
    ]
    primitive: dict[str, Any] = {"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}
    if indices is not None:
        accessors.append({"bufferView": 4, "componentType": 5125, "count": len(indices), "type": "SCALAR"})
        primitive["indices"] = 4
    content["nodes"].append({"name": "body", "mesh": 0, "skin": 0})
    content["scenes"][0]["nodes"].append(len(content["nodes"]) - 1)
    content |= {
        "buffers": [{"byteLength": start}],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": [{"primitives": [primitive]}],
        "skins": [{"joints": list(carrier.values()), "inverseBindMatrices": 3}],
    }
    return b"".join(array.tobytes() for array in arrays)


def _cloud(
    rng: np.random.Generator,
    worlds: list[tuple[Floats, Floats, float]],
    carrier: dict[int, int],
    joint: int,
    recipe: Recipe,
) -> Floats:
    """Points round a bone, from its joint to the next one."""
    at = worlds[carrier[joint]][0]
    below = np.flatnonzero(SKELETON.parents == joint)
    along = worlds[carrier[int(below[0])]][0] - at if len(below) else np.zeros(3)
    wide: Floats = 0.05 * recipe.unit * rng.uniform(-1.0, 1.0, (recipe.points, 3))
    return at + rng.uniform(0.0, 1.0, (recipe.points, 1)) * along + wide


def _add_vrm(content: dict[str, Any], carrier: dict[int, int], version: str) -> None:
    nodes = {bone: carrier[joint] for joint, bone in enumerate(SKELETON.names)}
    if version == "1":
        bones = {bone: {"node": node} for bone, node in nodes.items()}
        meta = {"name": "Made", "authors": ["A", "B"], "licenseUrl": "https://vrm.dev/licenses/1.0/"}
        content["extensions"] = {"VRMC_vrm": {"specVersion": "1.0", "meta": meta, "humanoid": {"humanBones": bones}}}
    if version == "0":
        listed = [{"bone": bone, "node": node} for bone, node in nodes.items()]
        meta = {"title": "Made", "author": "A", "licenseName": "CC0"}
        content["extensions"] = {"VRM": {"meta": meta, "humanoid": {"humanBones": listed}}}
    if version:
        content["extensionsUsed"] = list(content["extensions"])


def json_of(glb: bytes) -> dict[str, Any]:
    """The JSON of a GLB."""
    size = int.from_bytes(glb[12:16], "little")
    content: dict[str, Any] = json.loads(glb[20 : 20 + size])
    return content


def slow_world(content: dict[str, Any], changes: dict[int, dict[str, Floats]]) -> Floats:
    """World matrices (n, 4, 4) of a file's nodes by recursion over its JSON, with changed rotations or translations."""
    nodes = content["nodes"]
    world = np.full((len(nodes), 4, 4), np.nan)

    def visit(index: int, above: Floats) -> None:
        node = nodes[index] | changes.get(index, {})
        matrix = np.eye(4)
        if "matrix" in node and index not in changes:
            matrix = np.array(node["matrix"], float).reshape(4, 4).T
        else:
            matrix[:3, :3] = _matrix(node.get("rotation", [0, 0, 0, 1])) * np.array(node.get("scale", [1, 1, 1]))
            matrix[:3, 3] = node.get("translation", [0, 0, 0])
        world[index] = above @ matrix
        for child in node.get("children", []):
            visit(child, world[index])

    children = {child for node in nodes for child in node.get("children", [])}
    for root in set(range(len(nodes))) - children:
        visit(root, np.eye(4))
    return world


def _matrix(rotation: list[float]) -> Floats:
    x, y, z, w = np.array(rotation, float) / np.linalg.norm(rotation)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
