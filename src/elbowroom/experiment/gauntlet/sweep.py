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
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]

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
        self._upper = np.array([group is not DofGroup.ROOT for group in humanoid.capsules.groups])
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
        segments = posture_capsules(self._model, proof.configurations, proof.roots).astype(np.float64)
        radii = self._radii[:, None] + _half_moves(segments)
        heights = pelvis_frames(self._model, proof.roots)[0][:, 1]
        upper = segments[self._upper]
        variants = [_raised(upper, height - heights) for height in (self._standing, self._lowest)]
        if not line.straight:
            variants += [_turned(upper, proof.roots, angle) for angle in (-STEERING, STEERING)]
        sizes = [radii] + [radii[self._upper]] * len(variants)
        return rows_of(np.concatenate([segments, *variants]), np.concatenate(sizes), proof.way)

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


def _half_moves(segments: Floats) -> Floats:
    """Half the way (C, N) of each capsule's faster end to the neighbouring samples, for capsules (C, 6, N)."""
    steps = np.diff(segments.reshape(len(segments), 2, 3, -1), axis=3)
    moves = np.zeros((segments.shape[0], segments.shape[2] + 1))
    moves[:, 1:-1] = np.sqrt((steps**2).sum(axis=2)).max(axis=1)
    halves: Floats = 0.5 * np.maximum(moves[:, :-1], moves[:, 1:]) + _BEND
    return halves


def _raised(segments: Floats, heights: Floats) -> Floats:
    """Capsules (C, 6, N) lifted by heights (N,)."""
    raised = segments.copy()
    raised[:, [1, 4]] += heights
    return raised


def _turned(segments: Floats, roots: Floats, angle: float) -> Floats:
    """Capsules (C, 6, N) turned to the left about the upright axis through their root states (N, 7)."""
    turned = segments.copy()
    sine, cosine = np.sin(angle), np.cos(angle)
    for x, z in ((0, 2), (3, 5)):
        dx, dz = segments[:, x] - roots[:, 0], segments[:, z] - roots[:, 1]
        turned[:, x], turned[:, z] = roots[:, 0] + cosine * dx + sine * dz, roots[:, 1] + cosine * dz - sine * dx
    return turned
