"""The sheet: a row for each avatar, a column for each gesture, every figure as tall as the others."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.mesh_judge import region_of
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.skin import Skin, skin_of
from elbowroom.experiment.pose_sheet.capsule_skin import capsule_skin
from elbowroom.experiment.pose_sheet.gestures import GESTURES
from elbowroom.experiment.pose_sheet.lettering import Lettering
from elbowroom.experiment.pose_sheet.raster import draw
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]

WIDE, TALL, TOP, SIDE = 236, 316, 58, 236  # pixels: a figure's place, the head line, the names beside the rows
_FINER = 3  # each pixel is drawn as so many by so many
_FILL, _GROUND_AT = 0.70, 0.94  # of a place's height: a standing figure, and where it stands from the top
_VIEW = np.deg2rad(-35.0)  # the camera stands ahead and to the figure's left
_PAPER, _INK, _FAINT, _GROUND = (250, 249, 246), (38, 40, 44), (112, 114, 120), (229, 227, 221)
_COLORS = {
    "trunk": (96, 125, 139), "head": (222, 184, 150), "leftArm": (224, 122, 63), "rightArm": (66, 133, 191),
    "leftLeg": (176, 137, 104), "rightLeg": (125, 146, 116),
}  # fmt: skip
_LIGHT = np.array([-0.35, -0.6, 0.72])  # towards the light: columns, rows, nearness


def pose_sheet(
    humanoids: Sequence[Humanoid], capsules: bool = False, progress: Callable[[int], None] | None = None
) -> Image:
    """An RGB image (height, width, 3) of avatars in all gestures.

    `capsules` draws those instead of the surface; so are avatars drawn that have no mesh of a body.
    """
    image = np.full((TOP + TALL * len(humanoids), SIDE + WIDE * len(GESTURES), 3), _PAPER, np.uint8)
    for row, humanoid in enumerate(humanoids):
        top = TOP + row * TALL
        image[top : top + TALL, SIDE:] = _row(humanoid, capsules)
        if progress is not None:
            progress(row + 1)
    lettering = Lettering(image)
    for column, gesture in enumerate(GESTURES):
        lettering.centred(gesture.name, SIDE + int((column + 0.5) * WIDE), 18, 22, _INK)
    for row, humanoid in enumerate(humanoids):
        middle = TOP + row * TALL + TALL // 2
        below = lettering.wrapped(humanoid.name, 20, middle - 34, SIDE - 36, 23, _INK)
        lettering.wrapped(_about(humanoid), 20, below + 6, SIDE - 36, 16, _FAINT)
    return lettering.image()


def _about(humanoid: Humanoid) -> str:
    """What kind of file it is, and how high its head joint."""
    return f"{humanoid.meta.format or 'no file'}, head at {humanoid.skeleton.height:.2f} m"


def _row(humanoid: Humanoid, capsules: bool) -> Image:
    """One avatar in all gestures, side by side."""
    skin = skin_of(humanoid)[0] if humanoid.meta.has_body and not capsules else None
    skin = skin or capsule_skin(humanoid)
    poser = Poser(humanoid)
    local, hips = poser.local(
        np.array([gesture.q for gesture in GESTURES]), np.array([gesture.root.as_array() for gesture in GESTURES])
    )
    used = np.unique(skin.triangles)
    posed = poser.world(local, hips, np.zeros((len(GESTURES), 3)))
    points = np.zeros((len(GESTURES), len(skin.joints), 3))
    points[:, used] = skin.vertices(posed, used)
    standing = next(at for at, gesture in enumerate(GESTURES) if gesture.name == "hanging")
    stature = float(np.quantile(points[standing, used, 1], 0.999))
    colors = _colors(skin, humanoid)
    return np.concatenate([_cell(figure, skin, colors, stature) for figure in points], axis=1)


def _colors(skin: Skin, humanoid: Humanoid) -> Floats:
    """A colour for each triangle by the part of the body that carries most of it."""
    regions = np.array([_COLORS[region_of(bone)] for bone in humanoid.skeleton.names], np.float64)
    colors: Floats = regions[skin.joints[skin.triangles[:, 0], 0]]
    return colors


def _cell(points: Floats, skin: Skin, colors: Floats, stature: float) -> Image:
    wide, tall, ground = WIDE * _FINER, TALL * _FINER, int(_GROUND_AT * TALL) * _FINER
    turned = quaternion.rotate(quaternion.about_axis(1, _VIEW), points)
    scale = _FILL * tall / stature
    pixels = np.stack([0.5 * wide + scale * turned[:, 0], ground - scale * turned[:, 1], scale * turned[:, 2]], axis=1)
    canvas = np.full((tall, wide, 3), _PAPER, np.float64)
    canvas[ground:] = _GROUND
    draw(pixels, skin.triangles, colors, _LIGHT / np.linalg.norm(_LIGHT), canvas, np.full((tall, wide), -np.inf))
    finer = canvas.reshape(TALL, _FINER, WIDE, _FINER, 3).mean(axis=(1, 3))
    cell: Image = np.clip(finer, 0.0, 255.0).astype(np.uint8)
    return cell
