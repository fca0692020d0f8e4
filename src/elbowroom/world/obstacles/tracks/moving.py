"""Obstacles that move on tracks: where they are at any time, and what they sweep in a span of time.

A track has key poses; between them place and heading change evenly. Whoever plans ahead asks where things will be:
motion is known, not guessed. Another avatar is told about in the same way, by what its own plan says.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.layout import Nearby, Spans
from elbowroom.world.obstacles.meshes.packed import NOTHING, Packed
from elbowroom.world.obstacles.rows import rows_of
from elbowroom.world.obstacles.shapes import Shape, extents_of
from elbowroom.world.obstacles.tracks.poses import LOOP, ONCE, PINGPONG, Tracks, rows_at
from elbowroom.world.obstacles.tracks.sweeps import swept_rows

Floats = NDArray[np.float64]

FASTEST = 20.0  # m/s and rad/s


class Repeat(Enum):
    """What follows the last key pose of a track."""

    ONCE = "once"  # it stays there
    LOOP = "loop"  # it goes on to the first key pose
    PINGPONG = "pingpong"  # the same way back


_CODES = {Repeat.ONCE: ONCE, Repeat.LOOP: LOOP, Repeat.PINGPONG: PINGPONG}


@dataclass(frozen=True, eq=False)
class Track:
    """One shape, its own Y upright, and its motion."""

    name: str
    shape: Shape
    times: Floats  # (K,) seconds from the beginning, increasing; the first is 0, unless it is once
    centers: Floats  # (K, 3) of the shape's origin, metres
    yaws: Floats  # (K,) radians about Y
    repeat: Repeat = Repeat.ONCE  # a loop's last key pose is its first again

    @property
    def duration(self) -> float:
        """The time of the last key pose, seconds."""
        return float(self.times[-1])

    def within(self, times: ArrayLike) -> Floats:
        """Times (M,) as times between the first key pose and the last."""
        wanted, span = np.asarray(times, np.float64), self.duration
        if span == 0.0 or self.repeat is Repeat.ONCE:
            return np.clip(wanted, self.times[0], span)
        if self.repeat is Repeat.LOOP:
            return np.mod(wanted, span)
        return span - np.abs(np.mod(wanted, 2.0 * span) - span)

    def poses(self, times: ArrayLike) -> tuple[Floats, Floats]:
        """Centres (M, 3) and yaws (M,) at times (M,)."""
        at = self.within(times)
        centers = np.stack([np.interp(at, self.times, self.centers[:, i]) for i in range(3)], axis=-1)
        return centers, np.interp(at, self.times, self.yaws)


@dataclass(frozen=True, eq=False)
class Moving:
    """Some tracks; it never changes."""

    tracks: tuple[Track, ...] = field(default=())

    def __len__(self) -> int:
        return len(self.tracks)

    def __add__(self, others: "Moving") -> "Moving":
        """These and others; the same object, which knows itself by now, where there are no others."""
        return Moving(self.tracks + others.tracks) if others.tracks else self

    @property
    def names(self) -> tuple[str, ...]:
        """The obstacles' names."""
        return tuple(track.name for track in self.tracks)

    @property
    def half_sizes(self) -> Floats:
        """Half lengths (B, 3) of boxes about the shapes' origins, along their axes, that hold them."""
        halves: Floats = np.array([extents_of(track.shape) for track in self.tracks]).reshape(-1, 3)
        return halves

    @cached_property
    def fastest(self) -> float:
        """No point of any of them ever moves faster, m/s."""
        speeds = [0.0]
        for track in self.tracks:
            spans, reach = np.diff(track.times), float(np.linalg.norm(extents_of(track.shape)))
            ways = np.linalg.norm(np.diff(track.centers, axis=0), axis=1) + reach * np.abs(np.diff(track.yaws))
            speeds.extend((ways / spans).tolist())
        return max(speeds)

    def poses(self, times: ArrayLike) -> tuple[Floats, Floats]:
        """Centres (M, B, 3) and yaws (M, B) at times (M,)."""
        count = len(np.atleast_1d(times))
        if not self.tracks:
            return np.empty((count, 0, 3)), np.empty((count, 0))
        found = [track.poses(np.atleast_1d(times)) for track in self.tracks]
        return np.stack([center for center, _ in found], axis=1), np.stack([yaw for _, yaw in found], axis=1)

    def about_origin(self, packed: Packed | None = None) -> Nearby:
        """The obstacles, each with its origin where the world's is, not turned; `packed` as in `rows_of`."""
        count = len(self.tracks)
        turns = np.broadcast_to(quaternion.IDENTITY, (count, 4))
        return rows_of([track.shape for track in self.tracks], np.zeros((count, 3)), turns, packed)

    def at(self, time: float, shapes: Nearby | None = None) -> Nearby:
        """The obstacles as they stand at a time; their shapes `about_origin` may be known."""
        near = self._about_origin if shapes is None else shapes
        return Nearby(rows_at(self._kernel_tracks, near.rows, time), near.packed)

    def swept(self, times: Sequence[float] | Floats) -> Spans:
        """Boxes (n, B) that hold what each obstacle sweeps from each of the times (n+1,) to the next."""
        moments = np.asarray(times, np.float64)
        return self.swept_between(moments[:-1], moments[1:])

    def swept_between(self, first: Floats, last: Floats) -> Spans:
        """Boxes (n, B) that hold what each obstacle sweeps in each span of time, from `first` (n,) to `last`."""
        rows = swept_rows(self._kernel_tracks, np.ascontiguousarray(first), np.ascontiguousarray(last))
        return Spans(rows, NOTHING)

    @cached_property
    def _about_origin(self) -> Nearby:
        return self.about_origin()

    @cached_property
    def _kernel_tracks(self) -> Tracks:
        return _packed(self.tracks)


def _packed(tracks: tuple[Track, ...]) -> Tracks:
    """The tracks for the kernel."""
    starts = np.cumsum([0, *(len(track.times) for track in tracks)])
    poses = [np.concatenate([track.centers, track.yaws[:, None]], axis=1) for track in tracks]
    return Tracks(
        starts.astype(np.int64),
        np.concatenate([np.empty(0), *(track.times for track in tracks)]),
        np.concatenate([np.empty((0, 4)), *poses]),
        np.array([extents_of(track.shape) for track in tracks]).reshape(-1, 3),
        np.array([_CODES[track.repeat] for track in tracks], np.int64),
    )
