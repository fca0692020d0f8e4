"""Writes USD as text: a UsdSkel skeleton, its animation, and a figure of bones that is bound to it.

Source: openusd.org, "UsdSkel: skinning and skeletons", and the schemas of UsdSkel. Rows of matrices are USD's: a point
is a row vector.
"""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.bone_shapes import bone_shapes
from elbowroom.formats.gltf_animating import continuous
from elbowroom.formats.takes import Take

Floats = NDArray[np.float64]

AVATAR, SKELETON, ANIMATION = "avatar", "skeleton", "animation"  # names of prims
_BINDING = '(\n    prepend apiSchemas = ["SkelBindingAPI"]\n)'


def write_usda(take: Take, tips: Mapping[str, Floats], unit: float = 1.0, up: str = "y") -> bytes:
    """The take as a stage in text; `unit` is metres, `up` the take's own axis.

    `tips` (3,) are the ends of bones without a joint below, by node.
    """
    tree = take.tree
    paths = _paths(take)
    world = np.swapaxes(tree.world_matrices(tree.rotations), 1, 2)
    local = np.tile(np.eye(4), (len(tree), 1, 1))
    local[:, 3, :3] = tree.translations  # without rotations in the rest pose
    joints = ", ".join(f'"{path}"' for path in paths)
    rate = 1.0 / take.frame_time
    lines = [
        "#usda 1.0", "(", f'    defaultPrim = "{AVATAR}"',
        f'    upAxis = "{up.upper()}"', f"    metersPerUnit = {unit:g}",
        "    startTimeCode = 0", f"    endTimeCode = {len(take) - 1}", f"    timeCodesPerSecond = {rate:.9g}",
        f"    framesPerSecond = {rate:.9g}", ")", "",
        f'def SkelRoot "{AVATAR}" {_BINDING}', "{",
        f'def Skeleton "{SKELETON}" {_BINDING}', "{",
        f"    uniform token[] joints = [{joints}]",
        f"    uniform matrix4d[] bindTransforms = [{_rows(world)}]",
        f"    uniform matrix4d[] restTransforms = [{_rows(local)}]",
        f"    rel skel:animationSource = </{AVATAR}/{SKELETON}/{ANIMATION}>",
        f'    def SkelAnimation "{ANIMATION}" (', f"        displayName = {_quoted(take.name)}", "    )", "    {",
        f"        uniform token[] joints = [{joints}]",
        f"        half3[] scales = [{', '.join(['(1, 1, 1)'] * len(tree))}]",
        *_samples("float3[] translations", take.translations),
        *_samples("quatf[] rotations", _signed(take.rotations)[..., [3, 0, 1, 2]]),
        "    }", "}", *_figure(take, tips, unit), "}", "",
    ]  # fmt: skip
    return "\n".join(lines).encode()


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _paths(take: Take) -> list[str]:
    """Each joint as the path of names that leads to it."""
    tree = take.tree
    chains = [[*tree.ancestors(node)[::-1], node] for node in range(len(tree))]
    return ["/".join(tree.names[node] for node in chain) for chain in chains]


def _signed(rotations: Floats) -> Floats:
    return np.stack([continuous(rotations[:, joint]) for joint in range(rotations.shape[1])], axis=1)


def _samples(declared: str, values: Floats) -> Iterable[str]:
    """An attribute over time; values (F, n, w)."""
    yield f"        {declared}.timeSamples = {{"
    for frame, rows in enumerate(values.tolist()):
        yield f"            {frame}: [{_tuples(rows)}],"
    yield "        }"


def _figure(take: Take, tips: Mapping[str, Floats], unit: float) -> Iterable[str]:
    """A mesh whose every corner rides on one joint."""
    shapes = bone_shapes(take.tree, tips, unit)
    count = len(shapes.points)
    extent = np.stack([shapes.points.min(axis=0), shapes.points.max(axis=0)])
    single = '(\n        elementSize = 1\n        interpolation = "vertex"\n    )'
    yield f'def Mesh "bones" {_BINDING}'
    yield "{"
    yield f"    int[] faceVertexCounts = [{', '.join(['3'] * (count // 3))}]"
    yield f"    int[] faceVertexIndices = [{', '.join(map(str, range(count)))}]"
    yield f"    point3f[] points = [{_tuples(shapes.points.tolist())}]"
    yield f'    normal3f[] normals = [{_tuples(shapes.normals.tolist())}] (\n        interpolation = "vertex"\n    )'
    yield f"    float3[] extent = [{_tuples(extent.tolist())}]"
    yield '    uniform token subdivisionScheme = "none"'
    yield '    color3f[] primvars:displayColor = [(0.85, 0.82, 0.75)] (\n        interpolation = "constant"\n    )'
    yield f"    int[] primvars:skel:jointIndices = [{', '.join(map(str, shapes.joints.tolist()))}] {single}"
    yield f"    float[] primvars:skel:jointWeights = [{', '.join(['1'] * count)}] {single}"
    yield f"    rel skel:skeleton = </{AVATAR}/{SKELETON}>"
    yield "}"


def _rows(matrices: Floats) -> str:
    return ", ".join(f"({_tuples(matrix.tolist())})" for matrix in matrices)


def _tuples(rows: list[list[float]]) -> str:
    return ", ".join(f"({', '.join(f'{value:.9g}' for value in row)})" for row in rows)
