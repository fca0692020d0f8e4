"""The skeletons of UsdSkel and what animates them, as takes in metres, Y up.

Source: openusd.org, "UsdSkel: skinning and skeletons"; rows of matrices there are USD's: a point is a row vector.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.animations import KeyedAnimation, KeyedTrack, take_of
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.takes import MAX_POSES, Take
from elbowroom.formats.usd.placing import places, sampled_times
from elbowroom.formats.usd.prims import Attribute, Prim
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_MAX_JOINTS = 5_000
_SOURCE = "skel:animationSource"
_UPRIGHT = {"Y": quaternion.IDENTITY, "Z": quaternion.about_axis(0, -0.5 * np.pi)}
_RATE = 24.0  # time codes a second where a file says nothing
_UNIT = 0.01  # metres, likewise


@dataclass(frozen=True, eq=False)
class UsdSkeleton:
    """A Skeleton, the prims above it, and one animation of it."""

    name: str  # of the animation
    layer: Prim
    chain: tuple[Prim, ...]  # from below the layer down to the Skeleton, this included
    animation: Prim


def usd_skeletons(layer: Prim) -> tuple[UsdSkeleton, ...]:
    """Every SkelAnimation that a Skeleton is bound to, or one above it; unbound ones belong to the first Skeleton."""
    chains = _chains(layer)
    animations = {chain[-1].path: chain[-1] for chain in chains if chain[-1].kind == "SkelAnimation"}
    skeletons = [chain for chain in chains if chain[-1].kind == "Skeleton"]
    found: dict[str, tuple[Prim, ...]] = {}
    for chain in skeletons:
        bound = [path for prim in reversed(chain) for path in prim.texts(_SOURCE)]
        if bound and bound[0] in animations:
            found.setdefault(bound[0], chain)
    for path in animations if skeletons else ():
        found.setdefault(path, skeletons[0])
    return tuple(
        UsdSkeleton(animations[path].title or animations[path].name, layer, chain, animations[path])
        for path, chain in found.items()
    )


def _chains(layer: Prim) -> list[tuple[Prim, ...]]:
    """All skeletons and animations with the prims above them."""
    found = []
    waiting: list[tuple[Prim, ...]] = [(prim,) for prim in reversed(layer.children)]
    while waiting:
        chain = waiting.pop()
        if chain[-1].kind in ("Skeleton", "SkelAnimation"):
            found.append(chain)
        waiting += [(*chain, child) for child in reversed(chain[-1].children)]
    return found


def usd_take(skeleton: UsdSkeleton, place: str) -> Take:
    """The animation at equal time steps; raises `InputError`."""
    rate = skeleton.layer.number("timeCodesPerSecond", skeleton.layer.number("framesPerSecond", _RATE))
    if not 1e-3 <= rate <= 1e6:
        raise InputError(f"{skeleton.layer.file}: timeCodesPerSecond: {rate:g} is no rate")
    above = _above(skeleton)
    tree = _tree(skeleton, above)
    tracks = _of_joints(skeleton, len(above) + 1) + _of_prims(above)
    if not tracks:
        raise InputError(f"{place} has no rotations or translations over time")
    first = min(float(track.times[0]) for track in tracks)
    timed = tuple(KeyedTrack(t.node, t.path, t.mode, (t.times - first) / rate, t.values) for t in tracks)
    return take_of(KeyedAnimation(skeleton.name, timed, scaled=False), tree, place)


def _above(skeleton: UsdSkeleton) -> list[Prim]:
    """The prims of the chain that place what is in them."""
    return [prim for prim in skeleton.chain if prim.texts("xformOpOrder")]


def _tree(skeleton: UsdSkeleton, above: list[Prim]) -> NodeTree:
    """The rest pose: a node for unit and axis, one for each prim above, then the joints."""
    layer, prim = skeleton.layer, skeleton.chain[-1]
    paths = prim.texts("joints")
    if not paths or len(paths) > _MAX_JOINTS or len(set(paths)) < len(paths):
        raise InputError(f"{prim.file}: {prim.path}.joints must be 1 to {_MAX_JOINTS} different paths")
    translations, rotations, scales = _rest(prim, paths)
    up, unit = (layer.texts("upAxis") or ("Y",))[0], layer.number("metersPerUnit", _UNIT)
    if up not in _UPRIGHT or not 1e-6 <= unit <= 1e6:
        raise InputError(f"{layer.file}: upAxis {up[:10]!r} or metersPerUnit {unit:g} is none that there is")
    placed = [places(each, None) for each in above]
    number = {path: len(above) + 1 + i for i, path in enumerate(paths)}
    parents = [*range(-1, len(above)), *(_parent(path, number, len(above)) for path in paths)]
    nothing = np.full(len(parents), -1, dtype=np.int64)
    return NodeTree(
        ("stage", *(each.name for each in above), *(path.rpartition("/")[2] for path in paths)),
        np.array(parents, dtype=np.int64),
        np.array([*range(len(above) + 1), *sorted(number.values(), key=lambda node: _depth(paths, node, above))]),
        np.concatenate([np.zeros((1, 3)), *(moved for moved, _, _ in placed), translations]),
        np.concatenate([_UPRIGHT[up][None], *(turned for _, turned, _ in placed), rotations]),
        np.concatenate([np.full((1, 3), unit), *(scaled[None] for _, _, scaled in placed), scales]),
        nothing,
        nothing,
    )


def _parent(path: str, number: dict[str, int], top: int) -> int:
    """The node of the nearest joint above."""
    while "/" in path:
        path = path.rpartition("/")[0]
        if path in number:
            return number[path]
    return top


def _depth(paths: tuple[str, ...], node: int, above: list[Prim]) -> int:
    return paths[node - len(above) - 1].count("/")


def _rest(prim: Prim, paths: tuple[str, ...]) -> tuple[Floats, Floats, Floats]:
    """Local translations, rotations and scales of the joints in `restTransforms`."""
    value = prim.value("restTransforms")
    if not isinstance(value, np.ndarray) or value.shape != (16 * len(paths),):
        raise InputError(f"{prim.file}: {prim.path}.restTransforms must be {len(paths)} matrices, one for each joint")
    local = np.swapaxes(value.reshape(-1, 4, 4), 1, 2)
    scales = np.linalg.norm(local[:, :3, :3], axis=1)
    if not scales.min() > 1e-9:
        raise InputError(f"{prim.file}: {prim.path}.restTransforms: a matrix cannot be inverted")
    axes = local[:, :3, :3] / scales[:, None, :]
    if not np.linalg.det(axes).min() > 0.5:
        raise InputError(f"{prim.file}: {prim.path}.restTransforms: a matrix shears or mirrors")
    return local[:, :3, 3], np.stack([quaternion.from_matrix(each) for each in axes]), scales


def _of_joints(skeleton: UsdSkeleton, first: int) -> tuple[KeyedTrack, ...]:
    """What the animation does to each joint, by the time codes of the file; `first` is the node of the first joint."""
    prim = skeleton.animation
    places_of = {path: first + i for i, path in enumerate(skeleton.chain[-1].texts("joints"))}
    paths = prim.texts("joints") or tuple(places_of)
    nodes = [places_of.get(path) for path in paths]
    tracks = []
    for name, width, order in (("rotations", 4, [1, 2, 3, 0]), ("translations", 3, [0, 1, 2])):
        known = prim.attributes.get(name, Attribute())
        samples = known.samples or ({} if known.value is None else {0.0: known.value})
        if len(samples) * len(paths) > MAX_POSES:
            raise InputError(f"{prim.file}: {prim.path}.{name}: more than {MAX_POSES} values are not read")
        keys = sorted(samples)
        if keys:
            rows = np.stack([_rows(prim, name, samples[key], len(paths), width) for key in keys])[..., order]
            times = np.array(keys)
            tracks += [
                KeyedTrack(node, name[:-1], "LINEAR", times, rows[:, i])
                for i, node in enumerate(nodes)
                if node is not None
            ]
    return tuple(tracks)


def _rows(prim: Prim, name: str, value: object, joints: int, width: int) -> Floats:
    if not isinstance(value, np.ndarray) or value.size != joints * width:
        raise InputError(f"{prim.file}: {prim.path}.{name} must be {joints} times {width} numbers, one for each joint")
    rows = value.reshape(joints, width)
    if width == 4 and not np.linalg.norm(rows, axis=1).min() > 1e-6:
        raise InputError(f"{prim.file}: {prim.path}.{name}: a rotation has no direction")
    return rows


def _of_prims(above: list[Prim]) -> tuple[KeyedTrack, ...]:
    """What moves the prims above the skeleton."""
    tracks = []
    for node, prim in enumerate(above, start=1):
        times = sampled_times(prim)
        if len(times):
            moved, turned, _ = places(prim, times)
            tracks += [
                KeyedTrack(node, "translation", "LINEAR", times, moved),
                KeyedTrack(node, "rotation", "LINEAR", times, turned),
            ]
    return tuple(tracks)
