"""The animations of a glTF file: key frames of nodes, sampled at equal time steps (glTF 2.0, 3.11 and appendix C)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.accessors import read_accessor
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.takes import MAX_FRAMES, MAX_POSES, Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_MAX_ANIMATIONS, _MAX_CHANNELS = 1_000, 50_000
_PATHS = {"translation": "VEC3", "rotation": "VEC4", "scale": "VEC3"}
_MODES = ("LINEAR", "STEP", "CUBICSPLINE")
_RATES = (24.0, 25.0, 30.0, 50.0, 60.0, 90.0, 120.0)  # frames a second that key frames are usually baked at
_DEFAULT_RATE = 60.0
_LONGEST = 3600.0  # seconds


@dataclass(frozen=True, eq=False)
class KeyedTrack:
    """One property of one node over time."""

    node: int
    path: str  # "translation" or "rotation"
    mode: str  # "LINEAR", "STEP" or "CUBICSPLINE"
    times: Floats  # (K,) seconds, increasing
    values: Floats  # (K, w); CUBICSPLINE: (K, 3, w) in-tangent, value, out-tangent


@dataclass(frozen=True, eq=False)
class KeyedAnimation:
    """One animation: a clip by name."""

    name: str
    tracks: tuple[KeyedTrack, ...]
    scaled: bool  # it moves scales too, which are not read

    @property
    def span(self) -> tuple[float, float]:
        """First and last key time, seconds."""
        return min(float(t.times[0]) for t in self.tracks), max(float(t.times[-1]) for t in self.tracks)


def read_animations(gltf: Gltf, nodes: int) -> tuple[KeyedAnimation, ...]:
    """All animations that move nodes; `nodes` is the number of nodes. Raises `InputError`."""
    found = []
    times: dict[int, Floats] = {}
    for index, field in enumerate(gltf.root.at("animations").items(_MAX_ANIMATIONS)):
        channels = field.at("channels").items(_MAX_CHANNELS)
        paths = [channel.at("target").at("path").text() for channel in channels]
        moving = [c for c, path in zip(channels, paths, strict=True) if path in ("translation", "rotation")]
        tracks = [_track(gltf, field, channel, nodes, times) for channel in moving if _target(channel).present]
        if tracks:
            name = field.at("name").text() or f"animation {index}"
            found.append(KeyedAnimation(name, tuple(tracks), "scale" in paths))
    return tuple(found)


def _target(channel: Field) -> Field:
    return channel.at("target").at("node")


def _track(gltf: Gltf, animation: Field, channel: Field, nodes: int, known: dict[int, Floats]) -> KeyedTrack:
    node = _target(channel).integer(0, nodes - 1)
    path = channel.at("target").at("path").text()
    sampler = animation.at("samplers").pick(channel.at("sampler"))
    mode = sampler.at("interpolation").text("LINEAR")
    if mode not in _MODES:
        raise sampler.at("interpolation").wrong("LINEAR, STEP or CUBICSPLINE")
    times = _times(gltf, sampler.at("input"), known)
    values = read_accessor(gltf, sampler.at("output"), _PATHS[path])
    each = 3 if mode == "CUBICSPLINE" else 1
    if len(values) != each * len(times):
        raise InputError(f"{sampler.place}: {len(values)} values for {len(times)} key frames, {mode} needs {each} each")
    if mode == "CUBICSPLINE":
        values = values.reshape(len(times), 3, -1)
    return KeyedTrack(node, path, mode, times, values)


def _times(gltf: Gltf, field: Field, known: dict[int, Floats]) -> Floats:
    """The key times behind an accessor, read once for all tracks that share them."""
    index = field.integer(0, 10**9)
    if index not in known:
        times = read_accessor(gltf, field, "SCALAR")[:, 0]
        if times[0] < 0.0 or times[-1] > _LONGEST or not (np.diff(times) > 0.0).all():
            raise InputError(f"{field.place}: key times must increase from 0 on, and end within {_LONGEST:g} s")
        known[index] = times
    return known[index]


def take_of(animation: KeyedAnimation, tree: NodeTree, place: str) -> Take:
    """The animation at equal time steps: those of its own keys if it is baked, else 60 a second."""
    rate = _rate(animation)
    first, last = animation.span
    frames = round((last - first) * rate) + 1
    if frames > MAX_FRAMES or frames * len(tree) > MAX_POSES:
        raise InputError(f"{place}: {animation.name}: {frames} frames of {len(tree)} nodes are more than are read")
    times = first + np.arange(frames) / rate
    rotations, translations = np.tile(tree.rotations, (frames, 1, 1)), np.tile(tree.translations, (frames, 1, 1))
    for track in animation.tracks:
        target = rotations if track.path == "rotation" else translations
        target[:, track.node] = sample(track, times)
    return Take(animation.name, tree, 1.0 / rate, rotations, translations)


def _rate(animation: KeyedAnimation) -> float:
    """Key frames a second of the densest track, where it is a usual rate and a round number of its keys."""
    densest = max(animation.tracks, key=lambda track: len(track.times)).times
    if len(densest) < 2:
        return _DEFAULT_RATE
    rate = 1.0 / float(np.median(np.diff(densest)))
    near = min(_RATES, key=lambda usual: abs(usual - rate))
    return near if abs(near - rate) < 0.02 * near else _DEFAULT_RATE


def sample(track: KeyedTrack, times: Floats) -> Floats:
    """Values (F, w) at times (F,); before the first key and after the last one the track rests."""
    keys = track.times
    k = np.clip(np.searchsorted(keys, times, side="right") - 1, 0, max(len(keys) - 2, 0))
    after = np.minimum(k + 1, len(keys) - 1)
    width = np.maximum(keys[after] - keys[k], 1e-12)
    t = np.clip((times - keys[k]) / width, 0.0, 1.0)[:, None]
    if track.mode == "STEP":
        at = np.clip(np.searchsorted(keys, times, side="right") - 1, 0, len(keys) - 1)
        values: Floats = track.values[at]
    elif track.mode == "CUBICSPLINE":
        values = _hermite(track.values, k, after, width[:, None], t)
    elif track.path == "rotation":
        turns = quaternion.normalize(track.values)
        return quaternion.slerp(turns[k], turns[after], t[:, 0])
    else:
        values = track.values[k] + t * (track.values[after] - track.values[k])
    return quaternion.normalize(values) if track.path == "rotation" else values


def _hermite(values: Floats, k: NDArray[np.int64], after: NDArray[np.int64], width: Floats, t: Floats) -> Floats:
    """Cubic spline of glTF: tangents are per second."""
    a, out, b, into = values[k, 1], width * values[k, 2], values[after, 1], width * values[after, 0]
    tt, ttt = t * t, t * t * t
    spline: Floats = (2 * ttt - 3 * tt + 1) * a + (ttt - 2 * tt + t) * out + (3 * tt - 2 * ttt) * b + (ttt - tt) * into
    return spline
