"""A scene as triangles: what stands and moves in it, the ground, and the line to cross."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.export.animation import Animation
from elbowroom.formats.glb_draft import GlbDraft
from elbowroom.formats.gltf_animating import NodeMotion, joined_animation
from elbowroom.formats.gltf_merging import with_nodes_of
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.triangles import areas_of, triangles_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

COLORS = {
    "ground": (0.55, 0.55, 0.52),
    "standing": (0.75, 0.55, 0.35),
    "moving": (0.35, 0.55, 0.75),
    "finish": (0.2, 0.65, 0.3),
}  # of what has none of its own: red, green, blue
_THIN = 0.002  # metres that the finish lies above the ground


def place_glb(scene: Scene) -> bytes:
    """The scene as a GLB: the ground, the finish, and a node for each obstacle where it is at the beginning."""
    draft = GlbDraft()
    looks = _Looks(draft)
    x, z = scene.ground_center
    flat = _rectangle(*scene.ground_size)
    draft.add_node("ground", None, (x, 0.0, z), mesh=_mesh(draft, flat, looks.of(COLORS["ground"])))
    gate = scene.finish
    line = _mesh(draft, _rectangle(gate.width, 0.1), looks.of(COLORS["finish"]))
    place = (gate.position[0], _THIN, gate.position[1])
    draft.add_node("finish", None, place, quaternion.about_axis(1, gate.heading), mesh=line)
    for name, shape, center, turn in scene.obstacles:
        look = looks.of(color_of(scene, name, "standing"))
        draft.add_node(name, None, center, turn, mesh=_mesh(draft, triangles_of(shape), look))
    for track in scene.obstacles.moving.tracks:
        centers, yaws = track.poses([0.0])
        turn = quaternion.about_axis(1, float(yaws[0]))
        look = looks.of(color_of(scene, track.name, "moving"))
        draft.add_node(track.name, None, centers[0], turn, mesh=_mesh(draft, triangles_of(track.shape), look))
    return draft.finish()


def color_of(scene: Scene, name: str, kind: str) -> tuple[float, float, float]:
    """The colour of an obstacle, 0 to 1: its own, or that of its kind in `COLORS`."""
    own = scene.colors.get(name)
    if own is None:
        return COLORS[kind]
    red, green, blue = (int(own[at : at + 2], 16) / 255.0 for at in (1, 3, 5))
    return red, green, blue


def with_place(glb: bytes, scene: Scene, animation: Animation) -> bytes:
    """An animated GLB with the scene beside what it holds; what moves there by itself joins its first animation."""
    merged, numbers = with_nodes_of(glb, place_glb(scene))
    tracks, motions = scene.obstacles.moving.tracks, []
    for track, node in zip(tracks, numbers[len(numbers) - len(tracks) :], strict=True):
        centers, yaws = track.poses(animation.clock)
        motions.append(NodeMotion(node, quaternion.about_axis(1, yaws), centers))
    return joined_animation(merged, 1.0 / animation.fps, motions) if motions else merged


def _rectangle(width: float, depth: float) -> Floats:
    """Two triangles on the ground, seen from above."""
    x, z = 0.5 * width, 0.5 * depth
    a, b, c, d = (-x, 0.0, -z), (-x, 0.0, z), (x, 0.0, z), (x, 0.0, -z)
    return np.array([[a, b, c], [a, c, d]])


class _Looks:
    """The materials of a file, one for each colour."""

    def __init__(self, draft: GlbDraft) -> None:
        self._draft = draft
        self._made: dict[tuple[float, float, float], int] = {}

    def of(self, color: tuple[float, float, float]) -> int:
        """The number of a colour's material."""
        if color not in self._made:
            self._made[color] = _look(self._draft, color)
        return self._made[color]


def _look(draft: GlbDraft, color: tuple[float, float, float]) -> int:
    surface = {"baseColorFactor": [*color, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}
    return draft.add("materials", {"pbrMetallicRoughness": surface, "doubleSided": True})


def _mesh(draft: GlbDraft, triangles: Floats, material: int) -> int:
    """A mesh of flat triangles; those without an area are left out."""
    kept = triangles[areas_of(triangles) > 1e-12]
    kept = kept if len(kept) else triangles[:1]
    across = np.cross(kept[:, 1] - kept[:, 0], kept[:, 2] - kept[:, 0])
    lengths = np.linalg.norm(across, axis=1, keepdims=True)
    normals = np.where(lengths > 0.0, across / np.maximum(lengths, 1e-300), [0.0, 1.0, 0.0])
    attributes = {
        "POSITION": draft.add_vertices(kept.reshape(-1, 3), bounds=True),
        "NORMAL": draft.add_vertices(np.repeat(normals, 3, axis=0)),
    }
    return draft.add("meshes", {"primitives": [{"attributes": attributes, "material": material}]})
