"""H-Anim files made on the spot: any encoding, version, prefix, scale and up axis, skinned or in segments."""

import gzip
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from avatar_builder import normalised_fk
from elbowroom.geometry import quaternion
from odd_bodies import SKELETON

Floats = NDArray[np.float64]
Made = tuple[str, dict[str, Any]]  # kind, fields; a "USE" has its name in the field "name"

NAMES_2 = {
    "hips": "humanoid_root",
    "spine": "vl5",
    "chest": "vl1",
    "upperChest": "vt6",
    "neck": "vc4",
    "head": "skullbase",
}
_LIMBS = {
    "Shoulder": ("sternoclavicular", "sternoclavicular"),
    "UpperArm": ("shoulder", "shoulder"),
    "LowerArm": ("elbow", "elbow"),
    "Hand": ("radiocarpal", "wrist"),
    "UpperLeg": ("hip", "hip"),
    "LowerLeg": ("knee", "knee"),
    "Foot": ("talocrural", "ankle"),
    "Toes": ("metatarsophalangeal", "midtarsal"),
}
NAMES_1 = NAMES_2 | {"hips": "HumanoidRoot"}
for _side in ("left", "right"):
    for _bone, (_new, _old) in _LIMBS.items():
        NAMES_2[_side + _bone] = f"{_side[0]}_{_new}"
        NAMES_1[_side + _bone] = f"{_side[0]}_{_old}"


def _solid(kind: str, **fields: Any) -> Made:
    return ("Shape", {"geometry": [(kind, fields)]})


_SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
SOLIDS: tuple[Made, ...] = (
    _solid("Box", size=np.array([0.1, 0.2, 0.3])),
    _solid("Sphere", radius=0.1),
    _solid("Cylinder", radius=0.1, height=0.3, top=False),
    _solid("Cone", bottomRadius=0.1, height=0.3),
    _solid(
        "Extrusion", crossSection=_SQUARE[:, :2], spine=np.array([[0.0, 0, 0], [0, 1, 0], [1, 2, 0]]), creaseAngle=1.0
    ),
    _solid("ElevationGrid", xDimension=2, zDimension=3, height=np.arange(6.0)),
    _solid("TriangleSet", coord=[("Coordinate", {"point": _SQUARE[[0, 1, 2, 0, 2, 3]]})]),
    _solid("IndexedTriangleFanSet", index=np.arange(4), coord=[("Coordinate", {"point": _SQUARE})]),
    _solid("TriangleStripSet", stripCount=np.array([4]), coord=[("Coordinate", {"point": _SQUARE[[0, 1, 3, 2]]})]),
    _solid(
        "IndexedFaceSet",
        coordIndex=np.array([0, 1, 2, 3, -1]),
        convex=False,
        creaseAngle=0.5,
        colorPerVertex=False,
        coord=[("Coordinate", {"point": _SQUARE})],
        color=[("Color", {"color": np.array([[1.0, 0, 0]])})],
    ),
)

_PROTO_FIELDS = """  exposedField SFString name ""
  exposedField SFVec3f translation 0 0 0
  exposedField SFRotation rotation 0 0 1 0
  exposedField SFVec3f scale 1 1 1
  exposedField SFRotation scaleOrientation 0 0 1 0
  exposedField SFVec3f center 0 0 0
"""
_PLACED = "".join(
    f"{field} IS {field} " for field in ("translation", "rotation", "scale", "scaleOrientation", "center")
)
PROTOS_1 = (
    f"PROTO Joint [\n{_PROTO_FIELDS}  exposedField MFNode children [ ]\n]"
    f" {{ Transform {{ {_PLACED}children IS children }} }}\n"
    'PROTO Segment [ exposedField SFString name "" exposedField MFNode children [ ] ]\n'
    "{ Group { children IS children } }\n"
    f'PROTO Humanoid [\n{_PROTO_FIELDS}  field SFString version "1.1"\n  exposedField MFNode humanoidBody [ ]\n'
    f"  exposedField MFNode joints [ ]\n] {{ Transform {{ {_PLACED}children IS humanoidBody }} }}\n"
)


@dataclass(frozen=True)
class HanimRecipe:
    """What the file is to be like."""

    encoding: str = "xml"  # "xml", "classic" or "vrml"
    version: str = "2.0"  # "1.1": old names, and in VRML97 PROTOs of the file's own
    prefix: str = ""  # of DEF names
    named: bool = True  # the joints have names, not only DEF names
    skinned: bool = False
    arms_down: float = 1.4  # rest pose: upper arms below the horizontal, radians
    scale: float = 1.0  # of the humanoid; its joints are so much closer together
    z_up: bool = False
    bent: float = 0.0  # rotation of the elbows and of the spine as the file is saved, radians
    points: int = 20  # of the body round each joint
    packed: bool = False
    displaced: bool = False  # a displacer on the head of a skin
    extras: tuple[Made, ...] = ()  # shapes on the head
    listed: str = ""  # joints that `skeleton` lists once more by USE: "after" the figure, or "before", as DEFs


def build_hanim(recipe: HanimRecipe) -> bytes:
    """A file after the recipe; its figure is `SKELETON`, in H-Anim's default pose."""
    nodes: list[Made] = [("WorldInfo", {"title": "made"}), _humanoid(recipe)]
    if recipe.encoding == "xml":
        text = xml_file(nodes)
    else:
        x3d = "#X3D V3.3 utf8\nPROFILE Immersive\nCOMPONENT HAnim:1\n"
        header = "#VRML V2.0 utf8\n" if recipe.encoding == "vrml" else x3d
        protos = PROTOS_1 if recipe.encoding == "vrml" and recipe.version == "1.1" else ""
        text = header + protos + "\n".join(classic(node) for node in nodes) + "\n"
    return gzip.compress(text.encode()) if recipe.packed else text.encode()


def rest_positions(recipe: HanimRecipe) -> Floats:
    """Joint positions (J, 3) in the default pose, metres, Y up."""
    local = np.tile(quaternion.IDENTITY, (len(SKELETON.names), 1))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        local[SKELETON.index(f"{side}UpperArm")] = quaternion.about_axis(2, -sign * recipe.arms_down)
    return normalised_fk(SKELETON, local)[0]


def _humanoid(recipe: HanimRecipe) -> Made:
    old = recipe.version == "1.1" and recipe.encoding == "vrml"
    names = NAMES_1 if recipe.version == "1.1" else NAMES_2
    places = rest_positions(recipe) / recipe.scale
    if recipe.z_up:
        places = places[:, [2, 0, 1]]
    rng = np.random.default_rng(5)
    clouds = places[:, None, :] + 0.06 / recipe.scale * rng.uniform(-1.0, 1.0, (len(places), recipe.points, 3))
    made: list[Made] = []
    for joint, bone in enumerate(SKELETON.names):
        fields: dict[str, Any] = {"DEF": recipe.prefix + names[bone], "center": places[joint], "children": []}
        if recipe.named:
            fields["name"] = names[bone]
        if recipe.bent and (bone in ("spine", "chest") or bone.endswith("LowerArm")):
            fields["rotation"] = np.array([1.0, 0.0, 0.0, recipe.bent])
        if recipe.skinned:
            first = joint * recipe.points
            fields["skinCoordIndex"] = np.arange(first, first + recipe.points)
            fields["skinCoordWeight"] = np.ones(recipe.points)
            if recipe.displaced and bone == "head":
                fields["displacers"] = [_displacer(first)]
        else:
            shape = _shape({"point": clouds[joint]}, len(clouds[joint]))
            fields["children"].append(
                ("Segment" if old else "HAnimSegment", {"name": f"segment{joint}", "children": [shape]})
            )
        if bone == "head":
            fields["children"] += recipe.extras
        made.append(("Joint" if old else "HAnimJoint", fields))
        if joint:
            made[int(SKELETON.parents[joint])][1]["children"].append(made[-1])
    fields = {
        "DEF": "Figure",
        "name": "made",
        "version": recipe.version,
        "scale": np.full(3, recipe.scale),
        "humanoidBody" if old else "skeleton": _listed(made, recipe.listed),
        "joints": [("USE", {"name": node[1]["DEF"], "kind": node[0]}) for node in made],
    }
    if recipe.skinned:
        everything = clouds.reshape(-1, 3)
        fields["skin"] = [_shape({"DEF": "SkinCoord", "point": everything}, len(everything))]
        fields["skinCoord"] = [("USE", {"name": "SkinCoord", "kind": "Coordinate"})]
    return ("Humanoid" if old else "HAnimHumanoid", fields)


def _listed(made: list[Made], where: str) -> list[Made]:
    """The root joint, and beside it joints that hang below it already."""
    if where == "after":
        return made[:1] + [("USE", {"name": node[1]["DEF"], "kind": node[0]}) for node in made[1:]]
    if where == "before":  # the elbows are defined here and used in place
        elbows = [node for node in made if node[1]["DEF"].endswith("elbow")]
        for node in made:
            children = node[1]["children"]
            children[:] = [
                ("USE", {"name": child[1]["DEF"], "kind": child[0]}) if any(child is e for e in elbows) else child
                for child in children
            ]
        return [*elbows, *made[:1]]
    return made[:1]


def _displacer(point: int) -> Made:
    moves = np.array([[0.0, 0.05, 0.0], [0.0, 0.0, 0.05]])
    fields = {"name": "smile", "weight": 0.5, "coordIndex": np.array([point, point + 1]), "displacements": moves}
    return ("HAnimDisplacer", fields)


def _shape(coordinate: Mapping[str, Any], count: int) -> Made:
    index = np.arange(count // 4 * 4).reshape(-1, 4)
    faces = np.column_stack([index, np.full(len(index), -1)]).reshape(-1)
    material = ("Material", {"diffuseColor": np.array([0.8, 0.4, 0.2])})
    geometry = ("IndexedFaceSet", {"coordIndex": faces, "solid": False, "coord": [("Coordinate", dict(coordinate))]})
    return ("Shape", {"appearance": [("Appearance", {"material": [material]})], "geometry": [geometry]})


def classic(node: Made) -> str:
    """A node in the Classic encoding."""
    kind, fields = node
    if kind == "USE":
        return f"USE {fields['name']}"
    name = f"DEF {fields['DEF']} " if "DEF" in fields else ""
    inside = " ".join(f"{key} {_classic_value(key, value)}" for key, value in fields.items() if key != "DEF")
    return f"{name}{kind} {{ {inside} }}\n"


_SINGLE = {"coord", "color", "material", "appearance", "geometry", "skinCoord"}
_LISTS = {
    "point",
    "coordIndex",
    "skinCoordIndex",
    "skinCoordWeight",
    "crossSection",
    "spine",
    "height",
    "index",
    "stripCount",
}


def _classic_value(key: str, value: Any) -> str:
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        inside = "\n".join(classic(node) for node in value)
        return inside if key in _SINGLE else f"[\n{inside}]"
    numbers = " ".join(f"{number:.9g}" for number in np.asarray(value, float).reshape(-1))
    return f"[ {numbers} ]" if np.ndim(value) > 1 or (np.ndim(value) and key in _LISTS) else numbers


def xml_file(nodes: list[Made]) -> str:
    """A file in the XML encoding."""
    inside = "".join(xml(node, "") for node in nodes)
    head = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE X3D PUBLIC "ISO//Web3D//DTD X3D 4.0//EN" '
        '"https://www.web3d.org/specifications/x3d-4.0.dtd">\n<X3D profile="Immersive" version="4.0">\n'
        '<head><component name="HAnim" level="1"/><meta name="creator" content="a test"/>'
        '<meta name="license" content="CC0"/></head>\n'
    )
    return f"{head}<Scene>\n{inside}</Scene>\n</X3D>\n"


def xml(node: Made, container: str) -> str:
    """A node in the XML encoding."""
    kind, fields = node
    place = f' containerField="{container}"' if container else ""
    if kind == "USE":
        return f'<{fields["kind"]} USE="{fields["name"]}"{place}/>\n'
    attributes = "".join(
        f' {key}="{_xml_value(value)}"' for key, value in fields.items() if not isinstance(value, list)
    )
    parts = [(part, key) for key, value in fields.items() if isinstance(value, list) for part in value]
    inside = "".join(xml(part, key) for part, key in parts)
    return f"<{kind}{attributes}{place}>\n{inside}</{kind}>\n"


def _xml_value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    return " ".join(f"{number:.9g}" for number in np.asarray(value, float).reshape(-1))
