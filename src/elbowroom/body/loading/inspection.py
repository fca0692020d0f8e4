"""What is in an avatar's file, and what was made of it: facts to be shown."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from elbowroom.body.bones import PARENTS
from elbowroom.body.fitting.coverage import Coverage, coverage
from elbowroom.body.fitting.surface import Surface
from elbowroom.body.gait.cycle import gait_shape
from elbowroom.body.gait.stride import quickness, stride_length
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_with_surface
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.loading.size import crown_of
from elbowroom.errors import InputError
from elbowroom.formats.animations import read_animations
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh

WALK = 1.1  # m/s
_FAR_OUT = 0.03  # metres: a place that is farther outside is worth a warning, however small
_LEVEL, _HANGING = (
    15.0,
    65.0,
)  # degrees below the horizontal: above is T-pose, below hanging


@dataclass(frozen=True)
class ClipFact:
    """An animation in the file."""

    name: str
    seconds: float


@dataclass(frozen=True)
class AvatarFacts:
    """All there is to say about an avatar without walking it. Metres, degrees."""

    name: str
    format: str
    title: str
    authors: tuple[str, ...]
    licence: str
    contact: str
    permissions: dict[str, str]
    height: float  # to the crown
    head_joint: float
    hip_joint: float
    stride: float  # of a walk at `WALK`
    facing: float  # heading of the model in its file: 0 is +Z
    rest_pose: str
    bones: dict[str, dict[str, str | int]]  # bone -> node, name, how
    missing: tuple[str, ...]  # optional bones of the body that the file lacks
    capsules: dict[str, float]  # name -> radius
    coverage: Coverage | None  # of the surface by the capsules and 1 cm; None without a mesh that is the body
    vertices: int  # of the body
    triangles: int
    clips: tuple[ClipFact, ...] = ()
    notes: tuple[str, ...] = field(default_factory=tuple)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What may go wrong with this avatar."""
        found = self.coverage
        if found is None or (found.is_enough and found.worst <= _FAR_OUT):
            return ()
        part, worst = found.worst_part, 100.0 * found.worst
        return (
            f"{1.0 - found.share:.1%} of the surface is more than 1 cm outside the collision body, up to "
            f"{worst:.1f} cm at the {part}: there it may pass through things",
        )


def inspect_avatar(path: Path, settings: LoadSettings | None = None) -> tuple[AvatarFacts, Humanoid]:
    """Read an avatar and say what is in it; raises `InputError`."""
    humanoid, surface = load_with_surface(path, settings)
    return facts_of(humanoid, surface), humanoid


def facts_of(humanoid: Humanoid, surface: Surface) -> AvatarFacts:
    """The same for an avatar that is read already."""
    skeleton, meta, rig = humanoid.skeleton, humanoid.meta, humanoid.rig
    if humanoid.glb is None or rig is None:
        raise InputError(f"{humanoid.name}: has no file to look into")
    gltf = parse_gltf(humanoid.glb, humanoid.name)
    tree = read_nodes(gltf)
    fingers = ("Thumb", "Index", "Middle", "Ring", "Little")
    body = [bone for bone in PARENTS if not any(finger in bone for finger in fingers)]
    return AvatarFacts(
        name=humanoid.name,
        format=meta.format,
        title=meta.title,
        authors=meta.authors,
        licence=meta.licence,
        contact=meta.contact,
        permissions=meta.permissions.lines(),
        height=crown_of(humanoid, surface),
        head_joint=skeleton.height,
        hip_joint=float(skeleton.positions[0, 1]),
        stride=float(stride_length(WALK) / quickness(gait_shape(skeleton).scale)),
        facing=float(np.rad2deg(rig.facing)),
        rest_pose=_rest_pose(humanoid, tree.world_matrices(tree.rotations)[:, :3, 3]),
        bones={bone.bone: {"node": bone.node, "name": bone.name, "how": bone.how} for bone in meta.bones},
        missing=tuple(bone for bone in body if not skeleton.has(bone)),
        capsules=dict(zip(humanoid.capsules.names, humanoid.capsules.radii.tolist(), strict=True)),
        coverage=coverage(skeleton, humanoid.capsules, surface.samples) if meta.has_body else None,
        vertices=len(surface.vertices.positions),
        triangles=len(triangle_mesh(gltf, tree).triangles),
        clips=tuple(ClipFact(a.name, a.span[1] - a.span[0]) for a in read_animations(gltf, len(tree))),
        notes=meta.notes,
    )


def _rest_pose(humanoid: Humanoid, places: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    """How the arms are held in the file."""
    if humanoid.rig is None:
        return ""
    at = dict(zip(humanoid.skeleton.names, places[humanoid.rig.nodes], strict=True))
    arms = [at[f"{side}LowerArm"] - at[f"{side}UpperArm"] for side in ("left", "right")]
    down = float(np.mean([np.rad2deg(np.arcsin(-arm[1] / np.linalg.norm(arm))) for arm in arms]))
    kind = "T-pose" if abs(down) < _LEVEL else ("arms hanging" if down > _HANGING else "A-pose")
    return f"{kind}, upper arms {down:.0f}° below the horizontal" if down >= _LEVEL else kind
