"""An avatar file becomes a `Humanoid`: bones, T-pose, facing, unit, ground, collision body."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from elbowroom.body.bone_mapping.override import override_beside, read_override
from elbowroom.body.capsules import Capsules
from elbowroom.body.fitting.body_mesh import body_mesh, left_out_note, loose_nodes
from elbowroom.body.fitting.body_parts import SIDES
from elbowroom.body.fitting.fit import Fit, fit_capsules
from elbowroom.body.fitting.proportions import proportional_capsules
from elbowroom.body.fitting.rolling import soles_of
from elbowroom.body.fitting.stock_fit import stock_fit
from elbowroom.body.fitting.surface import Surface, surface_of, vertex_points
from elbowroom.body.humanoid import AvatarMeta, Humanoid
from elbowroom.body.loading.figure import figure_of, rig_of, skeleton_of
from elbowroom.body.loading.file_bones import file_bones
from elbowroom.body.loading.permissions import Permissions, of_vrm_0, of_vrm_1
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.loading.size import sized
from elbowroom.body.skeleton import Skeleton
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf, parse_gltf, read_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import pack_glb
from elbowroom.formats.triangles import triangle_mesh
from elbowroom.formats.vrm import VRM_0, Vrm, read_vrm
from elbowroom.formats.x3d.recognised import SUFFIXES, is_x3d

if TYPE_CHECKING:  # few avatars need it
    from elbowroom.body.loading.hanim import HanimAsset

# A mesh that shows next to nothing of more of these parts than so many is no body: tokens, a ball on a rig.
_CORE = frozenset({"chest", "head"} | {s + p for s in SIDES for p in ("Thigh", "Shin", "UpperArm", "Forearm")})
_CORE_SLIGHT = 3
_NO_BODY = "no mesh on most of the bones: the collision body has average proportions"


def load_humanoid(path: Path, settings: LoadSettings | None = None) -> Humanoid:
    """Read a VRM 0.x, VRM 1.0, glTF/GLB or H-Anim (X3D, VRML97) humanoid; raises `InputError`."""
    return load_with_surface(path, settings)[0]


def load_humanoid_bytes(data: bytes, name: str) -> Humanoid:
    """The same for the bytes of a file that was sent to us; it must not refer to other files."""
    if is_x3d(data) or name.lower().endswith(SUFFIXES):
        from elbowroom.body.loading.hanim import parse_hanim

        hanim = parse_hanim(data, name)
        return _humanoid(hanim.gltf, None, None, LoadSettings(), hanim)[0]
    return _humanoid(parse_gltf(data, name), None, None, LoadSettings())[0]


def load_with_surface(path: Path, settings: LoadSettings | None = None) -> tuple[Humanoid, Surface]:
    """The humanoid and its own surface to judge its capsules by."""
    chosen = settings or LoadSettings()
    override = _override(path, chosen)
    if path.name.lower().endswith(SUFFIXES):
        from elbowroom.body.loading.hanim import read_hanim

        hanim = read_hanim(path)
        return _humanoid(hanim.gltf, path, override, chosen, hanim)
    return _humanoid(read_gltf(path), path, override, chosen)


def _override(path: Path, settings: LoadSettings) -> Field | None:
    """The user's word on the bones of an avatar file, if there is one."""
    if isinstance(settings.bones, Mapping):
        return Field(dict(settings.bones), path.name)
    beside = settings.bones or override_beside(path)
    return None if beside is None else read_override(beside)


def _humanoid(
    gltf: Gltf, source: Path | None, override: Field | None, settings: LoadSettings, hanim: "HanimAsset | None" = None
) -> tuple[Humanoid, Surface]:
    tree = read_nodes(gltf)
    vrm = read_vrm(gltf, len(tree))
    bones = file_bones(gltf, tree, vrm, override, hanim.bones if hanim else None)
    figure = figure_of(gltf.name, bones.tree, bones.nodes, vrm.facing if vrm else None)
    carriers = list(bones.nodes.values())
    loose = frozenset[int]() if settings.include_hair else loose_nodes(bones.tree, carriers, vrm)
    body = body_mesh(triangle_mesh(bones.gltf, bones.tree), bones.tree, carriers, loose, figure.matrices)
    rig = rig_of(figure, vertex_points(body))
    skeleton = skeleton_of(figure, rig)
    own = body.moved(rig.to_model)
    surface = surface_of(own, skeleton)
    as_it_is = not bones.told and not settings.include_hair
    stock = stock_fit(gltf.glb, skeleton) if as_it_is else None
    fit = stock or fit_capsules(skeleton, surface)
    capsules, capsule_notes = _capsules(skeleton, fit)
    unit = () if rig.scale == 1.0 else (f"one unit of the file is taken for {rig.scale:g} m, from the figure's height",)
    told = hanim.meta if hanim else _meta(gltf, vrm)
    meta = replace(
        told,
        notes=told.notes + bones.notes + figure.notes + unit + left_out_note(bones.tree, body) + capsule_notes,
        bones=bones.sources,
        has_body=_NO_BODY not in capsule_notes,
    )
    read_with = replace(settings, bones=bones.told)
    # The feet of the stock avatar are taken for average ones: courses and recordings hang on how it walks.
    soles = None if stock else soles_of(skeleton, capsules, own if meta.has_body else None)
    glb = pack_glb(bones.gltf)
    humanoid = Humanoid(Path(gltf.name).stem, skeleton, capsules, rig, source, meta, read_with, glb, soles)
    return sized(humanoid, surface, settings.height, metric=figure.metric, place=gltf.name)


def _meta(gltf: Gltf, vrm: Vrm | None) -> AvatarMeta:
    """What a VRM or glTF file says about itself."""
    return AvatarMeta(
        title=vrm.title if vrm else "",
        authors=vrm.authors if vrm else (),
        licence=vrm.licence if vrm else gltf.root.at("asset").at("copyright").text(),
        format=vrm.version if vrm else "glTF 2.0",
        contact=str(vrm.meta.get("contactInformation", "")) if vrm else "",
        permissions=Permissions() if vrm is None else _permissions(vrm),
    )


def _permissions(vrm: Vrm) -> Permissions:
    return of_vrm_0(vrm.meta) if vrm.version == VRM_0 else of_vrm_1(vrm.meta)


def _capsules(skeleton: Skeleton, fit: Fit) -> tuple[Capsules, tuple[str, ...]]:
    """The collision body, and notes on what of it has average proportions."""
    if len(_CORE & set(fit.slight)) > _CORE_SLIGHT:
        return proportional_capsules(skeleton), (_NO_BODY,)
    return fit.capsules, (f"without mesh, of average proportions: {', '.join(fit.bare)}",) if fit.bare else ()
