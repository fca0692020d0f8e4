"""What was pushed in a run, as recordings keep it: who was in hand, where to, and where each loose thing was shown."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.controller import Controller
from elbowroom.world.moving_format import MAX_KEYS
from elbowroom.world.obstacles.tracks.moving import Moving, Track
from elbowroom.world.scene import Scene

# A row is written for a thing where anything but the step is other than in its last one.
THING = np.dtype(
    [
        ("step", "<u4"),  # counted from 0 over the whole recording
        ("number", "<u4"),  # among the scene's standing obstacles
        ("held", "u1"),  # whether it was in hand in this step
        ("to", "<f8", 2),  # x, z, where to; its own place where it was not
        ("at", "<f8", 2),  # x, z, where it was shown after the step
    ]
)
_CLOSEST = 0.01  # seconds between key poses of a track that is told to others
_NEAR = 5e-4  # metres by which such a track may be off, at least

Things = NDArray[np.void]
Floats = NDArray[np.float64]


Seen = Mapping[int, tuple[Any, ...]]  # of each thing, by its number, what a row tells of it


def seen_now(controller: Controller) -> Seen:
    """The things that were pushed, as they are after a step."""
    hand, seen = controller.hand, dict[int, tuple[Any, ...]]()
    for number, thing in controller.things.items():
        held = hand is not None and hand.number == number
        seen[number] = (held, hand.place if held and hand is not None else thing.place, thing.place)
    return seen


class ThingLog:
    """Notes the things of a run after each step."""

    def __init__(self) -> None:
        self._last: Seen = {}
        self._rows: list[tuple[Any, ...]] = []

    def note(self, step: int, seen: Seen) -> None:
        """What is new after this step."""
        self._rows += [(step, number, *told) for number, told in seen.items() if self._last.get(number) != told]
        self._last = seen

    def taken(self) -> Things:
        """All that was noted since this was called last."""
        rows, self._rows = np.array(self._rows, THING), []
        return rows


def obey(controller: Controller, rows: Iterable[Any]) -> None:
    """Push and let go before a step, as the rows of this step say; raises `InputError`."""
    for row in sorted(rows, key=lambda row: int(row["held"])):
        number = int(row["number"])
        if row["held"]:
            controller.push(number, (float(row["to"][0]), float(row["to"][1])))
        elif controller.hand is not None and controller.hand.number == number:
            controller.let_go()


def same_places(controller: Controller, rows: Iterable[Any]) -> bool:
    """Whether the things are after a step where its rows say, bit for bit."""
    things = controller.things
    found = ((things.get(int(row["number"])), row["at"]) for row in rows)
    return all(thing is not None and thing.place == (float(at[0]), float(at[1])) for thing, at in found)


def told(scene: Scene) -> Scene:
    """The scene with tracks of few key poses, as many as a scene's document may have; nothing is off by much."""
    moving = scene.obstacles.moving
    tracks = tuple(_few(track) for track in moving.tracks)
    return replace(scene, obstacles=replace(scene.obstacles, moving=Moving(tracks)))


def _few(track: Track) -> Track:
    if len(track.times) < MAX_KEYS and np.diff(track.times).min(initial=np.inf) >= _CLOSEST:
        return track
    near = _NEAR
    while len(kept := list(_kept(track, near))) >= MAX_KEYS:
        near *= 2.0
    return replace(track, times=track.times[kept], centers=track.centers[kept], yaws=track.yaws[kept])


def _kept(track: Track, near: float) -> Iterator[int]:
    """The key poses without which the track would be off by more than `near`, and its ends."""
    last, count = 0, len(track.times)
    yield 0
    for i in range(1, count - 1):
        times, centers = track.times[last : i + 2], track.centers[last : i + 2]
        share = ((times - times[0]) / (times[-1] - times[0]))[:, None]
        off = np.abs(centers[0] + share * (centers[-1] - centers[0]) - centers).max()
        if (off > near or i - last > MAX_KEYS) and track.times[i] - track.times[last] >= _CLOSEST:
            yield i
            last = i
    if count > 1:
        yield count - 1
