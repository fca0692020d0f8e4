"""All parts of the figure, meshed, coloured, weighted, and put into one file."""

from collections.abc import Callable

import numpy as np

from make_stock_avatar import clothes, palette
from make_stock_avatar.about import vrm_extension
from make_stock_avatar.cut import cut
from make_stock_avatar.eyes import Sheet, eyeball, joined, lash, lids, mirrored_sheet
from make_stock_avatar.features import brow, mouth, teeth
from make_stock_avatar.fields import Array, Field
from make_stock_avatar.hair import hair
from make_stock_avatar.hand import left_arm_mesh
from make_stock_avatar.head import calm, head
from make_stock_avatar.polygonise import Mesh, lattice, polygonise
from make_stock_avatar.shading import blush, figure, tinted
from make_stock_avatar.simplify import simplified
from make_stock_avatar.vrm import Figure, Material, Part, glb, mesh_node
from make_stock_avatar.weights import body_weights, quantised, rigid, shoe_weights

Weigh = Callable[[Array], Array]  # points (N, 3) -> weights (N, J)


def stock_avatar() -> bytes:
    """The stock avatar as the bytes of a VRM 1.0 file."""
    meshes = {"Body": _body(), "Head": _head(), **_face()}
    nodes = {name: mesh_node(list(meshes), name) for name in meshes}
    targets = {
        target: (nodes[name], i) for name, parts in meshes.items() for i, target in enumerate(sorted(parts[0].targets))
    }
    return glb(Figure(meshes, vrm_extension(nodes, targets)))


def _clay(field: Field, low: tuple[float, ...], high: tuple[float, ...], cell: float, points: int) -> Mesh:
    """A part meshed in cubes of `cell` metres and simplified to some `points`."""
    return simplified(polygonise(field, lattice(low, high, (cell, cell, cell))), field, points)


def _bare(mesh: Mesh, cover: Field, depth: float) -> Mesh:
    """The mesh less what lies deeper than `depth` (metres) under a cover."""
    return mesh.without(cover(mesh.points) < -depth)


def _body() -> tuple[Part, ...]:
    arm = _bare(left_arm_mesh(1300), clothes.shirt, 0.010)
    shirt = _clay(clothes.shirt, (-0.34, 0.90, -0.16), (0.34, 1.49, 0.16), 0.0090, 1000)
    collar = clothes.collar_mesh()
    trousers = _clay(clothes.trousers, (-0.21, 0.06, -0.16), (0.21, 1.07, 0.14), 0.0115, 950)
    shoe = _clay(clothes.shoe, (0.03, -0.01, -0.10), (0.17, 0.15, 0.20), 0.0070, 420)
    sole = _clay(clothes.sole, (0.03, -0.01, -0.10), (0.17, 0.06, 0.20), 0.0048, 240)
    shirt = _bare(shirt, clothes.trousers, 0.018)
    trousers = _bare(trousers, clothes.shirt, 0.030)
    shirt, bands = cut(shirt, np.abs(shirt.points[:, 0]) - clothes.SLEEVE_BAND)
    turn_ups, trousers = cut(trousers, trousers.points[:, 1] - clothes.TURN_UP)
    shoe = _bare(_bare(shoe, clothes.sole, 0.004), clothes.trousers, 0.012)
    return (
        _skin_part(_both(arm)),
        _cloth_part(shirt, palette.SHIRT, body_weights),
        _cloth_part(_together(collar, bands), palette.TRIM, body_weights),
        _cloth_part(trousers, palette.TROUSERS, body_weights),
        _cloth_part(turn_ups, palette.TURN_UPS, body_weights),
        _cloth_part(_both(shoe), palette.SHOES, shoe_weights),
        _cloth_part(_both(sole), palette.SOLES, shoe_weights),
    )


def _head() -> tuple[Part, ...]:
    skin = _clay(head, (-0.12, 1.37, -0.12), (0.12, 1.75, 0.14), 0.0050, 2000)
    locks = _clay(hair, (-0.14, 1.48, -0.15), (0.14, 1.78, 0.14), 0.0056, 1150)
    skin = _bare(_bare(skin, hair, 0.006), clothes.shirt, 0.012)
    locks_colours = tinted(locks, lambda p: np.minimum(hair(p), figure(p)), 0.8, np.array([0.45, 0.35, 0.3]))
    left, right = eyeball(1.0), mirrored_sheet(eyeball(-1.0))
    return (
        _skin_part(calm(skin), 0.25),
        _part(locks, palette.HAIR, locks_colours, lambda p: rigid(p, "head")),
        *(
            _part(eye.mesh, palette.EYES, eye.colours, lambda p, b=bone: rigid(p, b))  # type: ignore[misc]
            for eye, bone in ((left, "leftEye"), (right, "rightEye"))
        ),
    )


def _face() -> dict[str, tuple[Part, ...]]:
    """The moving parts of the face, one mesh for each set of shapes."""
    white = np.ones(3)
    return {
        "Eyelids": (_face_part(_paired(lids(white)), palette.LIDS), _face_part(_paired([lash(white)]), palette.LASHES)),
        "Brows": (_face_part(_paired([brow(white)]), palette.BROWS),),
        "Mouth": (_face_part(mouth(white), palette.MOUTH), _face_part(teeth(white), palette.TEETH)),
    }


def _face_part(sheet: Sheet, material: Material) -> Part:
    return _part(sheet.mesh, material, sheet.colours, lambda p: rigid(p, "head"), sheet.targets)


def _paired(sheets: list[Sheet]) -> Sheet:
    """Left and right of sheets; the target "blink" becomes one for each side."""
    left = [_renamed(sheet, "blinkLeft") for sheet in sheets]
    right = [mirrored_sheet(_renamed(sheet, "blinkRight")) for sheet in sheets]
    return joined(left + right)


def _renamed(sheet: Sheet, blink: str) -> Sheet:
    return Sheet(sheet.mesh, sheet.colours, {blink if n == "blink" else n: d for n, d in sheet.targets.items()})


def _both(mesh: Mesh) -> Mesh:
    """A left mesh and its mirror image."""
    return _together(mesh, mesh.mirrored())


def _together(one: Mesh, other: Mesh) -> Mesh:
    return Mesh(
        np.concatenate([one.points, other.points]),
        np.concatenate([one.normals, other.normals]),
        np.concatenate([one.triangles, other.triangles + len(one.points)]),
    )


def _skin_part(mesh: Mesh, depth: float = 0.7) -> Part:
    colours = blush(mesh.points, tinted(mesh, figure, depth, np.array(palette.CREASE)))
    return _part(mesh, palette.SKIN, colours, body_weights)


def _cloth_part(mesh: Mesh, material: Material, weigh: Weigh) -> Part:
    return _part(mesh, material, tinted(mesh, figure, 0.7, np.array(palette.SHADOW)), weigh)


def _part(
    mesh: Mesh, material: Material, colours: Array, weigh: Weigh, targets: dict[str, Array] | None = None
) -> Part:
    return Part(mesh, material, colours, *quantised(weigh(mesh.points)), targets or {})
