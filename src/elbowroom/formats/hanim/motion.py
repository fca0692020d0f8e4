"""What moves an H-Anim figure: interpolators driven by a TimeSensor (ISO/IEC 19775-1, 8.4.1 and 19.4).

Each TimeSensor is one animation. Its interpolators turn and move joints, the humanoid itself, or a Transform above it,
by routes that stand outside of PROTOs; Scripts and interpolators of other kinds are passed by.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.animations import KeyedAnimation, KeyedTrack, take_of
from elbowroom.formats.hanim.figure import HanimFigure, PlacedNode
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.takes import Take
from elbowroom.formats.x3d.model import Node, X3dScene
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_WIDTHS = {"rotation": ("OrientationInterpolator", 4), "translation": ("PositionInterpolator", 3)}
_LONGEST = 3600.0  # seconds of one cycle
_MAX_CLIPS = 1_000


def hanim_animations(figure: HanimFigure) -> tuple[KeyedAnimation, ...]:
    """What each TimeSensor moves, by its description or DEF name; raises `InputError` for wrong keys."""
    scene = figure.scene
    clocks = _clocks(scene)
    driven: dict[str, dict[tuple[int, str], str]] = {}  # clock -> node and path -> interpolator
    for route in scene.routes:
        path, placed = _plain(route.input), figure.placed.get(route.target)
        moves = path in _WIDTHS and placed is not None and _plain(route.output) == "value"
        if moves and placed is not None and route.source in clocks and _is(scene, route.source, _WIDTHS[path][0]):
            driven.setdefault(clocks[route.source], {})[placed.node, path] = route.source
    keys = _Keys(scene)
    return tuple(
        KeyedAnimation(
            scene.named[clock].text("description") or clock,
            tuple(keys.track(scene.named[clock], node, path, name) for (node, path), name in moved.items()),
            scaled=False,
        )
        for clock, moved in list(driven.items())[:_MAX_CLIPS]
    )


def hanim_take(animation: KeyedAnimation, figure: HanimFigure, tree: NodeTree, place: str) -> Take:
    """The animation at equal time steps; its rest pose is H-Anim's default pose, `tree` the nodes of the figure.

    What the animation moves rests where nothing has moved it yet; the rest of the figure stays as the file places it.
    """
    moved = {track.node for track in animation.tracks}
    posed, rest = _copy(tree), _copy(tree)
    for placed in figure.placed.values():
        posed.rotations[placed.node] = quaternion.multiply(placed.rotation, placed.stretch)
        if _rests(placed, figure, moved):
            rest.translations[placed.node] -= placed.translation
            rest.rotations[placed.node] = placed.stretch
    take = take_of(animation, posed, place)
    by_node = {placed.node: placed for placed in figure.placed.values()}
    for track in animation.tracks:
        placed = by_node[track.node]
        if track.path == "translation":
            take.translations[:, track.node] += tree.translations[track.node] - placed.translation
        else:
            take.rotations[:, track.node] = quaternion.multiply(take.rotations[:, track.node], placed.stretch)
    return Take(take.name, rest, take.frame_time, take.rotations, take.translations)


def _rests(placed: PlacedNode, figure: HanimFigure, moved: set[int]) -> bool:
    """Whether a node has a rest pose of its own, other than where the file has it."""
    if placed.kind == "HAnimJoint":
        return figure.centred
    return placed.kind == "HAnimHumanoid" and placed.node in moved


def _copy(tree: NodeTree) -> NodeTree:
    """The tree with rotations and translations that may be changed."""
    translations, rotations = tree.translations.copy(), tree.rotations.copy()
    return NodeTree(tree.names, tree.parents, tree.order, translations, rotations, tree.scales, tree.meshes, tree.skins)


def _clocks(scene: X3dScene) -> dict[str, str]:
    """For each node that a TimeSensor drives the sensor's name."""
    return {
        route.target: route.source
        for route in scene.routes
        if _plain(route.output) == "fraction"
        and _plain(route.input) == "fraction"
        and _is(scene, route.source, "TimeSensor")
    }


def _is(scene: X3dScene, name: str, kind: str) -> bool:
    return name in scene.named and scene.named[name].kind == kind


def _plain(field: str) -> str:
    """`rotation` for `set_rotation` and `rotation_changed`."""
    return field.removeprefix("set_").removesuffix("_changed")


class _Keys:
    """Key times and values of interpolators, each read once however many nodes it moves."""

    def __init__(self, scene: X3dScene) -> None:
        self._scene = scene
        self._values: dict[str, Floats] = {}
        self._times: dict[tuple[str, str], Floats] = {}

    def track(self, clock: Node, node: int, path: str, name: str) -> KeyedTrack:
        """What an interpolator does to a node; raises `InputError`."""
        interpolator = self._scene.named[name]
        if name not in self._values:
            values = interpolator.vectors("keyValue", _WIDTHS[path][1])
            self._values[name] = values if path == "translation" else _turns(values, self._scene.radian)
        if (clock.name, name) not in self._times:
            self._times[clock.name, name] = _cycle(clock) * _fractions(interpolator)
        times, values = self._times[clock.name, name], self._values[name]
        if len(values) != len(times):
            raise interpolator.wrong("keyValue", f"{len(times)} values, one for each key, not {len(values)}")
        return KeyedTrack(node, path, "LINEAR", times, values)


def _cycle(clock: Node) -> float:
    seconds = clock.number("cycleInterval", 1.0)
    if not 0.0 < seconds <= _LONGEST:
        raise clock.wrong("cycleInterval", f"more than 0 and at most {_LONGEST:g} s")
    return seconds


def _fractions(interpolator: Node) -> Floats:
    """Its keys (K,): parts of the cycle, not decreasing."""
    keys = interpolator.numbers("key")
    if not len(keys) or keys[0] < 0.0 or keys[-1] > 1.0 or not (np.diff(keys) >= 0.0).all():
        raise interpolator.wrong("key", "numbers that go up from 0 on, to 1 at most")
    return keys


def _turns(values: Floats, radian: float) -> Floats:
    """Quaternions (K, 4) of axes and angles (K, 4); an axis without direction turns nothing."""
    lengths = np.linalg.norm(values[:, :3], axis=1, keepdims=True)
    axes = np.where(lengths > 1e-12, values[:, :3] / np.maximum(lengths, 1e-12), 0.0)
    return quaternion.from_rotation_vector(axes * values[:, 3:] * radian)
