"""The scene of a recorded run as it was: what was pushed moves as it did, as an obstacle on a track.

A walk can be put back to its start, and all things with it. Where that came after a push, the scene's time goes on over
it, with a gap in which everything goes back; nobody is shown in a gap.
"""

from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.recordings.recorded_things import Things
from elbowroom.control.things.loose import Thing, scene_without, thing_of
from elbowroom.errors import InputError
from elbowroom.world.limits import FARTHEST
from elbowroom.world.obstacles.tracks.moving import FASTEST, Moving, Repeat, Track
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_GAP = 3.0 * FARTHEST / FASTEST  # seconds: enough for any way back
_MOST_KEYS = 200_000  # key poses of what moves by itself, in all its laps


class SceneClock(NamedTuple):
    """The scene's own time at N steps, seconds."""

    begins: Floats  # (N,) before each step
    ends: Floats  # (N,) after it
    anew: Longs  # the steps at which all is back where it was, though time goes on

    @classmethod
    def of(cls, dt: Floats, restarts: NDArray[np.bool_], things: Things) -> "SceneClock":
        """Steps of `dt` (N,) seconds; time begins anew with a restart (N,), unless something was pushed before it."""
        starts, times = np.flatnonzero(restarts[1:]) + 1, np.cumsum(dt)
        if len(things) and len(starts) and starts[-1] > things["step"].min():
            gaps = np.zeros(len(dt))
            gaps[starts] = _GAP
            times = times + np.cumsum(gaps)
            return cls(times - dt, times, starts)
        ends = times - np.maximum.accumulate(np.where(restarts, times - dt, 0.0))
        return cls(ends - dt, ends, np.empty(0, np.int64))


def walked_scene(scene: Scene, clock: SceneClock, things: Things) -> Scene:
    """The scene by this clock; raises `InputError` where what was pushed is told of what cannot be."""
    if not len(things):
        return scene
    if things["step"].max() >= len(clock.ends) or not (np.abs(things["at"]) <= FARTHEST).all():
        raise InputError(f"scene {scene.name}: what was pushed is told of steps that are missing, or beyond the world")
    if not (clock.ends >= clock.begins).all():
        raise InputError(f"scene {scene.name}: the time of the run does not go on")
    numbers = np.unique(things["number"]).tolist()
    pushed = tuple(_track(thing_of(scene, number), clock, things[things["number"] == number]) for number in numbers)
    still = scene_without(scene, frozenset(numbers))
    own = still.obstacles.moving.tracks
    if len(clock.anew):
        own = tuple(_begun_anew(track, clock) for track in own)
    return replace(still, obstacles=replace(still.obstacles, moving=Moving((*own, *pushed))))


def _track(thing: Thing, clock: SceneClock, rows: Things) -> Track:
    """Its way: where it was after each step that tells of it, and back at its place where all is."""
    way = _Way(thing.place)
    for step in sorted({*clock.anew.tolist(), *rows["step"].tolist()}):
        if step in clock.anew:
            way.go(clock.ends[step - 1], way.places[-1])
            way.go(clock.begins[step], thing.place)
        for row in rows[rows["step"] == step]:
            way.go(clock.begins[step], way.places[-1])
            way.go(clock.ends[step], (float(row["at"][0]), float(row["at"][1])))
    if len(way.times) == 1:
        way.go(1.0, way.places[-1])
    return thing.track(np.array(way.times), np.array(way.places))


class _Way:
    """Places at growing times."""

    def __init__(self, place: tuple[float, float]) -> None:
        self.times, self.places = [0.0], [place]

    def go(self, time: float, place: tuple[float, float]) -> None:
        """Be at a place at a time, if that is later than what is known."""
        if time > self.times[-1]:
            self.times.append(float(time))
            self.places.append(place)


def _begun_anew(track: Track, clock: SceneClock) -> Track:
    """A track that begins anew wherever all does, as long as the run lasts."""
    edges = [0, *clock.anew.tolist(), len(clock.ends)]
    spans = [(clock.begins[first], clock.ends[last - 1]) for first, last in pairwise(edges)]
    laps = sum(_laps(track, end - begin) for begin, end in spans)
    if laps * len(track.times) > _MOST_KEYS:
        raise InputError(f"scene: {track.name} goes {laps:.0f} times along its track: that is too much for one scene")
    times = [begin + _key_times(track, end - begin) for begin, end in spans]
    poses = [_poses(track, at - begin) for at, (begin, _) in zip(times, spans, strict=True)]
    centers, yaws = (np.concatenate(each) for each in zip(*poses, strict=True))
    return Track(track.name, track.shape, np.concatenate(times), centers, yaws)


def _poses(track: Track, moments: Floats) -> tuple[Floats, Floats]:
    """Centres (M, 3) and yaws (M,) at moments (M,); in a loop that turns, headings go on from lap to lap."""
    centers, yaws = track.poses(moments)
    if track.repeat is Repeat.LOOP and track.duration > 0.0:
        laps = np.round((moments - track.within(moments)) / track.duration)
        yaws = yaws + laps * (track.yaws[-1] - track.yaws[0])
    return centers, yaws


def _laps(track: Track, length: float) -> int:
    """How many times, forth or back, it goes along in so many seconds, at most."""
    return 1 if track.repeat is Repeat.ONCE or track.duration <= 0.0 else int(length / track.duration) + 1


def _key_times(track: Track, length: float) -> Floats:
    """The times of its key poses within so many seconds, with both ends."""
    span, there = track.duration, track.times
    turned = span - there if track.repeat is Repeat.PINGPONG else there
    every = [k * span + (turned if k % 2 else there) for k in range(_laps(track, length))]
    moments = np.unique(np.concatenate([*every, [0.0, length]]))
    kept: Floats = moments[moments <= length]
    return kept
