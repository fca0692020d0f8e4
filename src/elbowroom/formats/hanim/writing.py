"""Writes X3D 4: an H-Anim figure of bones that moves by interpolators (ISO/IEC 19774-1:2019, 19775-1:2023)."""

from collections.abc import Iterable, Mapping
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.bone_shapes import BoneShapes, bone_shapes
from elbowroom.formats.gltf_animating import continuous
from elbowroom.formats.takes import Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

FIGURE, TIMER = "hanim_figure", "timer"  # DEF names
_STILL = 1e-7
_HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE X3D PUBLIC "ISO//Web3D//DTD X3D 4.0//EN" "https://www.web3d.org/specifications/x3d-4.0.dtd">
<X3D profile="Immersive" version="4.0">
<head><component name="HAnim" level="1"/><meta name="generator" content="Elbowroom"/></head>
<Scene>"""
_LOOK = '<Appearance><Material diffuseColor="0.85 0.82 0.75"/></Appearance>'


def write_hanim(take: Take, tips: Mapping[str, Floats], names: Mapping[str, str]) -> bytes:
    """The take as an H-Anim figure: its rest pose has no rotations, metres, Y up.

    `names` says which node is which joint of H-Anim; a root that is none of them moves the whole figure. `tips` (3,)
    are the ends of bones without a joint below, by node.
    """
    return _Writer(take, tips, names).text().encode()


class _Writer:
    def __init__(self, take: Take, tips: Mapping[str, Floats], names: Mapping[str, str]) -> None:
        tree = take.tree
        self._take, self._names = take, names
        self._centers = tree.world_matrices(tree.rotations)[:, :3, 3]
        self._shapes: BoneShapes = bone_shapes(tree, tips)
        self._moving: list[str] = []  # interpolators and routes
        self._used: list[str] = []

    def text(self) -> str:
        tree = self._take.tree
        first = int(tree.order[0])
        own = tree.names[first] not in self._names
        top = [int(node) for node in np.flatnonzero(tree.parents == first)] if own else [first]
        fields = self._fields(first, FIGURE) if own else ""
        skeleton = [line for node in top for line in self._joint(node, "skeleton")]
        figure = f'<HAnimHumanoid DEF="{FIGURE}" name={quoteattr(self._take.name)} version="2.0"{fields}>'
        uses = [f'<HAnimJoint USE="{name}" containerField="joints"/>' for name in self._used]
        seconds = f"{max(len(self._take) - 1, 1) * self._take.frame_time:.9g}"
        said = quoteattr(self._take.name)
        timer = f'<TimeSensor DEF="{TIMER}" description={said} cycleInterval="{seconds}" loop="true"/>'
        body = [figure, *skeleton, *uses, "</HAnimHumanoid>", timer, *self._moving]
        return "\n".join([_HEAD, *body, "</Scene>", "</X3D>", ""])

    def _joint(self, node: int, place: str) -> Iterable[str]:
        """The lines of a joint, its bones, and all below it."""
        tree = self._take.tree
        name = self._names[tree.names[node]]
        used = f"hanim_{name}"
        self._used.append(used)
        fields = self._fields(node, used)
        center = _numbers(self._centers[node])
        yield f'<HAnimJoint DEF="{used}" name="{name}" center="{center}" containerField="{place}"{fields}>'
        points, normals = self._shapes.of(node)
        if len(points):
            yield f'<HAnimSegment name={quoteattr(tree.names[node])} containerField="children">'
            yield f"<Shape>{_LOOK}<TriangleSet>"
            yield f'<Coordinate point="{_numbers(points)}"/><Normal vector="{_numbers(normals)}"/>'
            yield "</TriangleSet></Shape></HAnimSegment>"
        for child in np.flatnonzero(tree.parents == node):
            yield from self._joint(int(child), "children")
        yield "</HAnimJoint>"

    def _fields(self, node: int, used: str) -> str:
        """Where a joint is at the beginning; what moves it later is kept for the end of the file."""
        turns = _axis_angles(self._take.rotations[:, node])
        moved = self._take.translations[:, node] - self._take.tree.translations[node]
        self._interpolate("Orientation", used, "rotation", turns)
        self._interpolate("Position", used, "translation", moved)
        return f' translation="{_numbers(moved[0])}" rotation="{_numbers(turns[0])}"'

    def _interpolate(self, kind: str, used: str, field: str, values: Floats) -> None:
        """Nothing for what stays at rest; two keys for what stays elsewhere, so that it is told from the rest pose."""
        if np.ptp(values, axis=0).max() <= _STILL:
            if np.abs(values[0, -3 if field == "translation" else -1 :]).max() <= _STILL:
                return
            values = values[[0, 0]]
        name = f"{used}_{field}"
        keys = _numbers(np.linspace(0.0, 1.0, len(values)))
        self._moving += [
            f'<{kind}Interpolator DEF="{name}" key="{keys}" keyValue="{_numbers(values)}"/>',
            f'<ROUTE fromNode="{TIMER}" fromField="fraction_changed" toNode="{name}" toField="set_fraction"/>',
            f'<ROUTE fromNode="{name}" fromField="value_changed" toNode="{used}" toField="set_{field}"/>',
        ]


def _axis_angles(rotations: Floats) -> Floats:
    """Axis and angle (F, 4) of rotations (F, 4)."""
    turns = continuous(quaternion.normalize(rotations))
    sine = np.linalg.norm(turns[:, :3], axis=1, keepdims=True)
    axes = np.where(sine > 1e-12, turns[:, :3] / np.maximum(sine, 1e-12), [0.0, 0.0, 1.0])
    return np.concatenate([axes, 2.0 * np.arctan2(sine, turns[:, 3:])], axis=1)


def _numbers(values: Floats) -> str:
    return " ".join(f"{value:.8g}" for value in np.ravel(values).tolist())
