"""The space that bodies sweep on a course: what obstacles have to leave free, and what they have to touch."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, followed
from elbowroom.body.gait.stride import phase_rate
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules, pelvis_frames, posture_capsules
from elbowroom.experiment.gauntlet.body_rows import BodyRows, joined, rows_of
from elbowroom.experiment.gauntlet.certificate import Certificate
from elbowroom.experiment.gauntlet.line import CourseLine, walk_along
from elbowroom.experiment.gauntlet.speeds import WALK_SPEED
from elbowroom.jit import exact_kernel
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Segments = NDArray[np.float32]
Indices = NDArray[np.int64]

STEERING = 0.06  # radians by which the heading may differ from that of a line that turns
_BEND = 2e-4  # metres: more than the path within a sample interval differs from its chord
_PHASES = 32
_OFFSETS = np.arange(8) / 8.0  # strides: the phases in which a natural walk may come along
_SPACING = 0.02  # metres between the poses of the natural walk
_STANCE_SPACING, _SIGHT_SPACING, _SIGHT_STEP = 0.05, 0.10, 0.20  # metres
_USUAL = 1.51  # metres, the stock avatar's head joint
_ALIKE = (0.8, 1.25)  # bodies of such a scale get obstacles of the same size
_LOW = 0.1  # metres: lower end of the stance's axis
_SIGHT, _LEADS = 3.4, (0.0, 0.3, 0.6)  # metres: how far ahead the way of the legs is looked at, and steered


class SweptBody:
    """Poses of one humanoid along a line as rows of capsules; frozen once made.

    `scale` says how many times as tall it is as the stock avatar; 1 exactly for bodies of usual size.
    """

    def __init__(self, humanoid: Humanoid) -> None:
        scale = humanoid.skeleton.height / _USUAL
        self.scale = 1.0 if _ALIKE[0] <= scale <= _ALIKE[1] else round(scale, 2)
        self._model = body_model(humanoid)
        self._radii = humanoid.capsules.radii
        self._upper = np.flatnonzero([group is not DofGroup.ROOT for group in humanoid.capsules.groups])
        stride = np.zeros((_PHASES, 7))
        stride[:, 3], stride[:, 6] = WALK_SPEED, np.arange(_PHASES) / _PHASES
        self._lowest = float(pelvis_frames(self._model, stride)[0][:, 1].min())
        self._standing = float(pelvis_frames(self._model, np.zeros((1, 7)))[0][0, 1])
        legs, radii = leg_capsules(self._model, stride).astype(np.float64), self._model.roots.radii.astype(np.float64)
        self._breadth = float((np.abs(legs[:, [0, 3]]).max(axis=(1, 2)) + radii).max())
        self._top = float((legs[:, [1, 4]].max(axis=(1, 2)) + radii).max())

    def certificate(self, proof: Certificate, line: CourseLine) -> BodyRows:
        """What has to keep the margin: every pose, and the upper body at the extreme heights of the pelvis.

        On a line that turns also the upper body turned to either side: no user steers exactly.
        Radii have grown by half the way that a capsule moves to the next sample: who keeps a distance from the rows
        keeps it between the samples.
        """
        segments = posture_capsules(self._model, proof.configurations, proof.roots)
        heights = pelvis_frames(self._model, proof.roots)[0][:, 1]
        lifts = np.stack([self._standing - heights, self._lowest - heights])
        angles = np.array([] if line.straight else [-STEERING, STEERING])
        axes = _with_variants(segments, self._upper, proof.roots, lifts, np.sin(angles), np.cos(angles))
        radii = self._radii[:, None] + _half_moves(segments)
        sizes = [radii] + [radii[self._upper]] * (len(lifts) + len(angles))
        return BodyRows(axes.reshape(-1, 6), np.concatenate(sizes).ravel(), np.tile(proof.way, len(axes)))

    def natural_walks(self, line: CourseLine, first: float, last: float) -> list[BodyRows]:
        """The upper body of the natural walk on a part of the way, once for each of eight phases."""
        way = np.arange(first, last, _SPACING)
        walk, strides = walk_along(line, way, WALK_SPEED, 0.0), phase_rate(WALK_SPEED, 0.0, 0.0) / WALK_SPEED
        walks = np.tile(walk, (len(_OFFSETS), 1, 1))
        walks[:, :, 6] = _OFFSETS[:, None] + strides * way
        goals = [natural_walk()(RootPath(0.0, 1.0, states)) for states in walks]
        states = walks.reshape(-1, walks.shape[2])
        q = np.concatenate([states[:, :3], followed(np.concatenate(goals))], axis=1)
        segments = np.split(posture_capsules(self._model, q, states)[self._upper], len(walks), axis=2)
        return [rows_of(capsules, self._radii[self._upper], way) for capsules in segments]

    def stances(self, line: CourseLine) -> BodyRows:
        """Upright capsules as broad as walking legs and pelvis, along the line.

        On a line that turns also straight ahead of each of its points, as far as walkers look: what stands there would
        divert their legs.
        """
        way = np.arange(0.0, line.length, _STANCE_SPACING)
        rows = [self._stances_at(line.points(way), way)]
        if not line.straight:
            ahead = np.arange(_SIGHT_SPACING, _SIGHT, _SIGHT_SPACING)
            begins = np.arange(0.0, line.length, _SIGHT_STEP)
            for lead in _LEADS:
                heading = line.heading(begins + lead)
                views = np.stack([np.sin(heading), np.cos(heading)], axis=-1)
                places = line.points(begins)[:, None] + ahead[:, None] * views[:, None]
                rows.append(self._stances_at(places.reshape(-1, 2), np.repeat(begins, len(ahead))))
        return joined(*rows)

    def _stances_at(self, places: Floats, way: Floats) -> BodyRows:
        axes = np.empty((len(places), 6))
        axes[:, [0, 3]], axes[:, [2, 5]] = places[:, :1], places[:, 1:]
        axes[:, 1], axes[:, 4] = _LOW, self._top - self._breadth
        return BodyRows(axes, np.full(len(places), self._breadth), way)


@exact_kernel
def _half_moves(segments: Segments) -> Floats:
    """Half the way (C, N) of each capsule's faster end to the neighbouring samples, for capsules (C, 6, N)."""
    moves = np.zeros((segments.shape[0], segments.shape[2]))
    for c in range(segments.shape[0]):
        for n in range(segments.shape[2] - 1):
            square = 0.0
            for k in (0, 3):
                x = np.float64(segments[c, k, n + 1]) - np.float64(segments[c, k, n])
                y = np.float64(segments[c, k + 1, n + 1]) - np.float64(segments[c, k + 1, n])
                z = np.float64(segments[c, k + 2, n + 1]) - np.float64(segments[c, k + 2, n])
                square = max(square, x * x + y * y + z * z)
            moves[c, n + 1] = np.sqrt(square)
            moves[c, n] = max(moves[c, n], moves[c, n + 1])
    halves: Floats = 0.5 * moves + _BEND
    return halves


@exact_kernel
def _with_variants(
    segments: Segments, upper: Indices, roots: Floats, lifts: Floats, sines: Floats, cosines: Floats
) -> Floats:
    """Capsules (C, 6, N) as (C + U (V + W), N, 6): as they are, then the upper body, at indices (U,), in variants.

    It is lifted by heights (V, N), then turned to the left by W angles about the upright axis through roots (N, 7).
    """
    plain, moved, count = segments.shape[0], len(upper), segments.shape[2]
    axes = np.empty((plain + moved * (len(lifts) + len(sines)), count, 6))
    for c in range(plain):
        for n in range(count):
            for k in range(6):
                axes[c, n, k] = segments[c, k, n]
    for i in range(moved):
        for n in range(count):
            x, z, own = roots[n, 0], roots[n, 1], axes[upper[i], n]
            for k in (0, 3):
                dx, dz = own[k] - x, own[k + 2] - z
                for lift in range(len(lifts)):
                    end = axes[plain + lift * moved + i, n, k : k + 3]
                    end[0], end[1], end[2] = own[k], own[k + 1] + lifts[lift, n], own[k + 2]
                for turn in range(len(sines)):
                    end = axes[plain + (len(lifts) + turn) * moved + i, n, k : k + 3]
                    sine, cosine = sines[turn], cosines[turn]
                    end[0], end[1], end[2] = x + cosine * dx + sine * dz, own[k + 1], z + cosine * dz - sine * dx
    return axes
