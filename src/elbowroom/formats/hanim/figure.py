"""The humanoid of an X3D or VRML97 file as a glTF under construction, with its joints' names.

H-Anim gives joints their places by `center`, in the coordinates of the whole figure, and rotations about them; glTF
gives each node a place relative to its parent. A joint therefore becomes a node at its center, and what hangs on it is
moved back by that center. The figure stands in H-Anim's default pose, in which all joints are unturned.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.file_bytes import read_file
from elbowroom.formats.glb_draft import GlbDraft
from elbowroom.formats.gltf import Gltf, parse_gltf
from elbowroom.formats.hanim.displacers import Displacer, displacers_in
from elbowroom.formats.hanim.humanoid_node import (
    coord_of,
    info_of,
    is_centred,
    loa_of,
    path_to_humanoid,
    shapes_in,
    skeleton_roots,
)
from elbowroom.formats.hanim.skin import skin_weights
from elbowroom.formats.x3d.expand import MAX_NODES as MAX_VISITED
from elbowroom.formats.x3d.expand import expand
from elbowroom.formats.x3d.files import MAX_BYTES, FilesBeside, parse_x3d
from elbowroom.formats.x3d.materials import Materials, linear_colours
from elbowroom.formats.x3d.mesh import Mesh
from elbowroom.formats.x3d.model import Node, Nodes, Notes, X3dScene
from elbowroom.formats.x3d.parts import shown_parts
from elbowroom.formats.x3d.placing import TRANSFORMS, placing_of
from elbowroom.formats.x3d.shapes import triangles_of
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_MAX_NODES = 10_000  # Transforms, joints and shapes, those that USE repeats counted each time
_MAX_VERTICES = 2_000_000
_MAX_SHAPES = 3_000  # different ones


@dataclass(frozen=True, eq=False)
class Joint:
    """An HAnimJoint and the glTF node that it became."""

    node: int
    name: str  # its `name`, "" if the file gives none
    definition: str  # its DEF name
    centre: Floats  # (3,) in the coordinates of the humanoid


@dataclass(frozen=True, eq=False)
class PlacedNode:
    """A node with a DEF name that places what is in it, as the file has it, and the glTF node that it became."""

    node: int
    kind: str  # "Transform", "HAnimJoint", ...
    translation: Floats  # (3,)
    rotation: Floats  # (4,) xyzw
    stretch: Floats  # (4,) xyzw, of `Placing`


@dataclass(frozen=True, eq=False)
class HanimFigure:
    """A humanoid, ready to be written as glTF; whoever reads it may still turn `top` or add nodes to the draft."""

    file: str
    draft: GlbDraft
    top: int  # the node that everything hangs on
    joints: tuple[Joint, ...]  # parents before children
    name: str
    version: str  # of H-Anim, as the file says, e.g. "2.0"
    loa: int | None  # level of articulation, where the file says it
    info: dict[str, str]  # of the humanoid and the header: authorName, copyright, license, ...
    notes: tuple[str, ...]
    scene: X3dScene  # as it was written
    placed: dict[str, PlacedNode]  # by DEF name
    centred: bool  # its joints stand in H-Anim's default pose, not as the file turns them

    def gltf(self) -> Gltf:
        """What the draft holds now."""
        return parse_gltf(self.draft.finish(), self.file)


def read_figure(path: Path, default_pose: bool = True) -> HanimFigure:
    """The humanoid of a file; raises `InputError`. Without `default_pose` its joints stay as the file turns them."""
    return parse_figure(read_file(path, MAX_BYTES), path.name, path.parent, default_pose)


def parse_figure(data: bytes, file: str, folder: Path | None = None, default_pose: bool = True) -> HanimFigure:
    """The same for bytes; `folder` is where files that it names may lie (none for an upload)."""
    notes = Notes()
    scene = parse_x3d(data, file, notes)
    beside = FilesBeside(folder, notes)
    return _Maker(scene, expand(scene, beside), beside, notes, default_pose).figure()


def parse_scenery(data: bytes, file: str, folder: Path | None = None) -> tuple[Gltf, tuple[str, ...]]:
    """All that a file shows, be there a humanoid in it or not, as it stands; with notes on what was left out.

    `folder` is where files that it names may lie. Raises `InputError`.
    """
    notes = Notes()
    scene = parse_x3d(data, file, notes)
    beside = FilesBeside(folder, notes)
    made = _Maker(scene, expand(scene, beside), beside, notes, default_pose=False).scenery()
    return made, tuple(notes.lines)


class _Maker:
    def __init__(self, scene: X3dScene, roots: Nodes, beside: FilesBeside, notes: Notes, default_pose: bool) -> None:
        self._scene, self._roots, self._notes = scene, roots, notes
        self._draft = GlbDraft()
        self._materials = Materials(self._draft, beside, notes)
        self._meshes: dict[int, tuple[int, Mesh] | None] = {}
        self._joints: list[tuple[Joint, Node]] = []
        self._placed: set[int] = set()  # joints; each has one place, wherever else the file repeats it
        self._displacers: dict[int, tuple[Displacer, ...]] = {}  # by the Coordinate node whose points they move
        self._vertices = self._shapes = 0
        self._default_pose = default_pose
        self._named: dict[str, PlacedNode] = {}

    def figure(self) -> HanimFigure:
        top = self._draft.add_node("figure", scale=np.full(3, self._scene.metre))
        path = path_to_humanoid(self._roots)
        humanoid = path[-1] if path else None
        self._centred = self._default_pose and is_centred(humanoid)
        parent, offset = top, np.zeros(3)
        for above in path[:-1]:
            if above.kind in TRANSFORMS:
                parent, offset = self._transform(above, parent, offset)
        self._walk([humanoid] if humanoid else self._roots, parent, offset)
        return HanimFigure(
            file=self._scene.file,
            draft=self._draft,
            top=top,
            joints=tuple(joint for joint, _ in self._joints),
            name=humanoid.text("name") if humanoid else "",
            version=humanoid.text("version") if humanoid else "",
            loa=loa_of(humanoid),
            info=info_of(self._scene, humanoid),
            notes=tuple(self._notes.lines),
            scene=self._scene,
            placed=self._named,
            centred=self._centred,
        )

    def scenery(self) -> Gltf:
        """Everything in the file."""
        self._centred = False
        top = self._draft.add_node("scene", scale=np.full(3, self._scene.metre))
        self._walk(self._roots, top, np.zeros(3))
        return parse_gltf(self._draft.finish(), self._scene.file)

    def _walk(self, roots: Nodes, parent: int, offset: Floats) -> None:
        """Draw everything in `roots`, which hang on a node whose origin lies at `offset` in their coordinates."""
        waiting = [(node, parent, offset) for node in reversed(roots)]
        visited = 0
        while waiting:
            node, parent, offset = waiting.pop()
            visited += 1
            if visited > MAX_VISITED:
                raise InputError(f"{node.place}: more than {MAX_VISITED} nodes are shown")
            if node.kind == "Shape":
                self._shape(node, parent, offset)
                continue
            if node.kind == "HAnimJoint":
                if id(node) in self._placed:
                    continue
                self._placed.add(id(node))
            if node.kind in TRANSFORMS:
                parent, offset = self._transform(node, parent, offset)
            if node.kind == "HAnimSegment":
                self._displace(node.node("coord"), [node])
            if node.kind == "HAnimHumanoid":
                before = len(self._joints)
                self._walk(skeleton_roots(node), parent, offset)
                self._skin(node, self._joints[before:], parent, offset)
                continue
            waiting += [(part, parent, offset) for part in reversed(shown_parts(node))]

    def _transform(self, node: Node, parent: int, offset: Floats) -> tuple[int, Floats]:
        """The glTF node of a Transform, and what its origin is in the coordinates of the nodes inside."""
        placing = placing_of(node, self._scene.radian)
        if len(self._draft.nodes) >= _MAX_NODES:
            raise InputError(f"{node.place}: the figure has more than {_MAX_NODES} Transforms, joints and shapes")
        is_joint = node.kind == "HAnimJoint"
        rotation = quaternion.IDENTITY if is_joint and self._centred else placing.rotation
        made = self._draft.add_node(
            (node.text("name") if is_joint else "") or node.name or node.kind,
            parent,
            placing.translation + placing.center - offset,
            rotation if placing.stretch is quaternion.IDENTITY else quaternion.multiply(rotation, placing.stretch),
            placing.scale,
        )
        if node.name:
            placed = PlacedNode(made, node.kind, placing.translation, placing.rotation, placing.stretch)
            self._named.setdefault(node.name, placed)
        if is_joint:
            self._joints.append((Joint(made, node.text("name"), node.name, placing.center), node))
        if placing.stretch is not quaternion.IDENTITY:
            made = self._draft.add_node("", made, rotation=quaternion.conjugate(placing.stretch))
        return made, placing.center

    def _shape(self, node: Node, parent: int, offset: Floats) -> None:
        if id(node) not in self._meshes:
            self._meshes[id(node)] = self._mesh(node)
        made = self._meshes[id(node)]
        if made is not None:
            self._draft.add_node(node.name, parent, -offset, mesh=made[0])

    def _mesh(self, node: Node) -> tuple[int, Mesh] | None:
        """The glTF mesh of a Shape; None without faces."""
        geometry = node.node("geometry")
        mesh = triangles_of(geometry) if geometry else None
        if mesh is None or not len(mesh.triangles):
            return None
        return self._add_mesh(node, mesh, {}), mesh

    def _add_mesh(self, node: Node, mesh: Mesh, skinning: dict[str, int]) -> int:
        moving = self._displacers.get(id(coord_of(node)), ())
        targets = [(each, target) for each in moving if (target := each.target(mesh.sources)) is not None]
        self._vertices += len(mesh.points) * (1 + len(targets))
        self._shapes += 1
        if self._vertices > _MAX_VERTICES or self._shapes > _MAX_SHAPES:
            raise InputError(f"{node.place}: more than {_MAX_SHAPES} shapes or {_MAX_VERTICES} vertices are shown")
        draft = self._draft
        attributes = {"POSITION": draft.add_vertices(mesh.points, bounds=True)} | skinning
        if mesh.normals is not None:
            attributes["NORMAL"] = draft.add_vertices(mesh.normals)
        if mesh.colours is not None:
            attributes["COLOR_0"] = draft.add_vertices(linear_colours(mesh.colours))
        if mesh.uvs is not None:
            attributes["TEXCOORD_0"] = draft.add_vertices(mesh.uvs * [1.0, -1.0] + [0.0, 1.0])
        material = self._materials.material(
            node.node("appearance"), mesh.colours is not None, mesh.uvs is not None, mesh.two_sided
        )
        primitive = {"attributes": attributes, "indices": draft.add_indices(mesh.triangles), "material": material}
        if not targets:
            return draft.add("meshes", {"primitives": [primitive]})
        primitive["targets"] = [{"POSITION": draft.add_vertices(target, bounds=True)} for _, target in targets]
        weights, names = [each.weight for each, _ in targets], [each.name for each, _ in targets]
        return draft.add("meshes", {"primitives": [primitive], "weights": weights, "extras": {"targetNames": names}})

    def _displace(self, coord: Node | None, holders: Nodes) -> None:
        """Remember the displacers of joints or a segment for the shapes that have these points."""
        if coord is not None and id(coord) not in self._displacers:
            self._displacers[id(coord)] = displacers_in(holders, len(coord.vectors("point", 3)))

    def _skin(self, humanoid: Node, joints: list[tuple[Joint, Node]], parent: int, offset: Floats) -> None:
        """The shapes in `skin`: those that share the points of `skinCoord` follow the joints, others the humanoid."""
        shapes = list(shapes_in(humanoid.nodes("skin")))
        coord = humanoid.node("skinCoord") or next((c for shape in shapes if (c := coord_of(shape))), None)
        moving = [shape for shape in shapes if coord is not None and coord_of(shape) is coord]
        for shape in shapes:
            if shape not in moving:
                self._shape(shape, parent, offset)
        if coord is None or not moving or not joints:
            return
        self._displace(coord, [node for _, node in joints])
        weights = skin_weights([node for _, node in joints], len(coord.vectors("point", 3)))
        binds = np.tile(np.eye(4), (len(joints), 1, 1))
        binds[:, :3, 3] = [-joint.centre for joint, _ in joints]
        skin = self._draft.add(
            "skins",
            {
                "joints": [joint.node for joint, _ in joints],
                "inverseBindMatrices": self._draft.add_vertices(binds.transpose(0, 2, 1)),
            },
        )
        for shape in moving:
            geometry = shape.node("geometry")
            mesh = triangles_of(geometry) if geometry else None
            if mesh is None or not len(mesh.triangles):
                continue
            attributes = {
                "JOINTS_0": self._draft.add_vertices(weights.joints[mesh.sources], "<u2"),
                "WEIGHTS_0": self._draft.add_vertices(weights.weights[mesh.sources]),
            }
            self._draft.add_node(shape.name or "skin", mesh=self._add_mesh(shape, mesh, attributes), skin=skin)
