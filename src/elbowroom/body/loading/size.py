"""How tall an avatar is: as its file has it, as the user asks, or smaller where its head is too large for metres."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.body_parts import part_of_points
from elbowroom.body.fitting.proportions import proportional_capsules
from elbowroom.body.fitting.surface import Surface
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.settings import SHORTEST, TALLEST
from elbowroom.errors import InputError

LARGEST_HEAD = 0.45  # metres from chin to crown: of a person 3.4 m tall
_ASKED = 1e-3  # relative difference of heights that is none
_LOOSE = 0.005  # share of the head's points at either end that are not measured


def crown_of(humanoid: Humanoid, surface: Surface) -> float:
    """Height in metres of the head's highest point above the ground; of its capsule where it has no mesh."""
    heights = _head(humanoid, surface)
    if len(heights):
        return float(heights.max())
    capsules = humanoid.capsules
    head = [i for i, name in enumerate(capsules.names) if name.startswith("head")]
    rest = humanoid.skeleton.positions[capsules.joints[head], 1]
    ends = np.maximum(capsules.starts[head, 1], capsules.ends[head, 1])
    return float(np.max(rest + ends + capsules.radii[head]))


def head_height(humanoid: Humanoid, surface: Surface) -> float:
    """Metres from the lowest to the highest point of the head; 0 without a mesh on it."""
    heights = _head(humanoid, surface)
    return float(np.ptp(np.quantile(heights, [_LOOSE, 1.0 - _LOOSE]))) if len(heights) else 0.0


def _head(humanoid: Humanoid, surface: Surface) -> NDArray[np.float64]:
    """Heights (P,) of the points of the head above the ground."""
    average = proportional_capsules(humanoid.skeleton)
    head = part_of_points(humanoid.skeleton, average, surface.vertices) == average.names.index("head")
    heights: NDArray[np.float64] = surface.vertices.positions[head, 1]
    return heights


def sized(
    humanoid: Humanoid, surface: Surface, height: float | None, *, metric: bool, place: str
) -> tuple[Humanoid, Surface]:
    """The avatar and its surface as tall as was asked for, or, where nothing was, no larger than its head allows.

    Without a mesh that is its body the head says nothing, nor does it in a file that is `metric` (VRM). Raises
    `InputError` for an avatar too small or too tall to walk.
    """
    crown = crown_of(humanoid, surface)
    if height is not None:
        return _scaled(humanoid, surface, height / crown, f"scaled to a height of {height:g} m")
    head = head_height(humanoid, surface) if humanoid.meta.has_body and not metric else 0.0
    if head > LARGEST_HEAD:
        factor = LARGEST_HEAD / head
        keeps = f" (--height {crown:.2f} keeps its size)" if crown <= TALLEST else ""
        note = (
            f"its head is {head:.2f} m high, so the file is taken to have a unit of its own: scaled by {factor:.2f} to "
            f"{factor * crown:.2f} m{keeps}"
        )
        humanoid, surface = _scaled(humanoid, surface, factor, note)
        crown *= factor
    if not SHORTEST <= round(crown, 3) <= TALLEST:
        why = " (a VRM is in metres)" if metric else ""
        raise InputError(
            f"{place}: the avatar is {crown:.3g} m tall{why}: avatars of {SHORTEST:g} to {TALLEST:g} m can "
            "walk; --height sets another height"
        )
    return humanoid, surface


def _scaled(humanoid: Humanoid, surface: Surface, factor: float, note: str) -> tuple[Humanoid, Surface]:
    if abs(factor - 1.0) < _ASKED or humanoid.rig is None:
        return humanoid, surface
    skeleton, capsules = humanoid.skeleton, humanoid.capsules
    scaled = replace(
        humanoid,
        skeleton=replace(skeleton, positions=factor * skeleton.positions),
        capsules=replace(
            capsules,
            starts=factor * capsules.starts,
            ends=factor * capsules.ends,
            radii=factor * capsules.radii,
        ),
        soles=None if humanoid.soles is None else humanoid.soles.scaled(factor),
        rig=replace(humanoid.rig, scale=factor * humanoid.rig.scale),
        meta=replace(humanoid.meta, notes=(*humanoid.meta.notes, note)),
    )
    return scaled, surface.scaled(factor)
