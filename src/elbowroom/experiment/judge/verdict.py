"""The judge's verdict on a shown motion: what touches, how near it comes, how smoothly it moves."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.recordings.recording import Recording
from elbowroom.experiment.judge.capsule_judge import CapsuleJudge
from elbowroom.experiment.judge.case import Case
from elbowroom.experiment.judge.derivatives import Derivatives, derivatives
from elbowroom.experiment.judge.ledger import Contact, Ledger, Nearness
from elbowroom.experiment.judge.mesh_judge import MeshJudge
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.obstacles import Surroundings, surroundings_of
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.self_judge import self_judge
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.skin import skin_of
from elbowroom.experiment.judge.soles import RaisedSoles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_AT_ONCE = 1200  # poses

Progress = Callable[[float], object]  # is told how many seconds of the motion are judged


@dataclass(frozen=True)
class BodyVerdict:
    """What one body, the capsules or the mesh, was found to do."""

    touching: int  # poses
    touching_assisted: int  # of these, poses shown while the planner was at work
    deepest: float  # metres, 0 where nothing touches
    least: Nearness | None  # the nearest moment; None without obstacles
    contacts: tuple[Contact, ...]  # the deepest first
    tolerance: float  # metres


@dataclass(frozen=True)
class Verdict:
    """The verdict on one motion."""

    frames: int  # as recorded
    poses: int  # judged
    left: int  # poses that were not judged any more, since it was broken off
    seconds: float  # of motion
    capsules: BodyVerdict
    mesh: BodyVerdict | None  # None: not asked for, or the avatar has none
    itself: BodyVerdict  # the collision body against itself: parts in each other deeper than in the natural walk
    mesh_note: str  # why there is no mesh, else empty
    triangles: int  # of the mesh that were judged
    triangles_left_out: int  # moved by springs, or rigid things on a skinned body
    smoothness: dict[str, Derivatives]

    @property
    def clean(self) -> bool:
        """Whether all was judged, and no obstacle is touched; what the body does to itself is a figure of its own."""
        return self.left == 0 and self.capsules.touching == 0 and (self.mesh is None or self.mesh.touching == 0)


def judge_recording(
    recording: Recording, humanoid: Humanoid, settings: JudgeSettings | None = None, progress: Progress | None = None
) -> Verdict:
    """Judge what a recording shows, in its own scene; raises `InputError` where it is not valid."""
    scene = recording.scene()
    return judge(ShownMotion.of(recording), humanoid, scene, settings, progress)


def judge(
    motion: ShownMotion,
    humanoid: Humanoid,
    scene: Scene,
    settings: JudgeSettings | None = None,
    progress: Progress | None = None,
) -> Verdict:
    """Judge a motion of an avatar in a scene.

    Raises `InputError` where the collision library is missing or the avatar's mesh is damaged.
    """
    judging = Judging(motion, humanoid, scene, settings)
    for time in judging.parts():
        if progress is not None:
            progress(time)
    return judging.verdict()


class Judging:
    """A motion of an avatar in a scene while it is judged: who breaks it off has the verdict on what was judged.

    Raises as `judge` does.
    """

    def __init__(
        self, motion: ShownMotion, humanoid: Humanoid, scene: Scene, settings: JudgeSettings | None = None
    ) -> None:
        chosen = settings or JudgeSettings()
        self._motion, self._moments, self.judged = motion, motion.moments(chosen.rate), 0  # poses
        self._surroundings, self._poser = surroundings_of(scene), Poser(humanoid)
        self._skin, self._note = skin_of(humanoid) if chosen.mesh else (None, "not asked for")
        self._of_capsules, self._of_mesh = Ledger(chosen.capsule_tolerance), Ledger(chosen.mesh_tolerance)
        self._of_itself, self._itself = Ledger(chosen.self_tolerance), self_judge(humanoid)
        self._soles = RaisedSoles(humanoid, self._poser, motion, floors=math.isinf(scene.obstacles.ground))
        around = [surroundings.obstacles for surroundings in self._surroundings]
        self._capsules, skin = [CapsuleJudge(humanoid, obstacles) for obstacles in around], self._skin
        self._mesh = [] if skin is None else [MeshJudge(skin, humanoid.skeleton, obstacles) for obstacles in around]

    @property
    def poses(self) -> int:
        """How many poses there are."""
        return len(self._moments.times)

    def parts(self) -> Iterator[float]:
        """Judge one part after the other; gives the seconds of the motion that are judged."""
        for first in range(self.judged, self.poses, _AT_ONCE):
            some = self._moments.part(slice(first, first + _AT_ONCE))
            self._judge(some, first)
            self.judged = first + len(some.times)
            yield float(some.times[-1])

    def _judge(self, some: Moments, first: int) -> None:
        posed, clock = self._poser.at(self._motion, some), self._motion.scene_times(some)
        body = Case(self._soles.raised(posed, some), some.times, first, self._of_capsules)
        for around, capsules in zip(self._surroundings, self._capsules, strict=True):
            _judge_near(around, capsules, body, clock)
        self._itself.judge(Case(posed, some.times, first, self._of_itself))
        if self._skin is not None:
            surface = Case(self._soles.raised(posed, some, self._skin), some.times, first, self._of_mesh)
            for around, mesh in zip(self._surroundings, self._mesh, strict=True):
                _judge_near(around, mesh, surface, clock)

    def verdict(self) -> Verdict:
        """On all that is judged by now."""
        motion, moments, skin = self._motion, self._moments, self._skin
        return Verdict(
            frames=len(motion),
            poses=self.judged,
            left=self.poses - self.judged,
            seconds=float(motion.times[-1] - motion.times[0]),
            capsules=_body_verdict(self._of_capsules, motion, moments),
            mesh=None if skin is None else _body_verdict(self._of_mesh, motion, moments),
            itself=_body_verdict(self._of_itself, motion, moments),
            mesh_note=self._note,
            triangles=0 if skin is None else len(skin.triangles),
            triangles_left_out=0 if skin is None else skin.left_out,
            smoothness=derivatives(motion),
        )


def _judge_near(around: Surroundings, judge: CapsuleJudge | MeshJudge, case: Case, clock: Floats) -> None:
    """Have those poses of a case judged at which what moves is near; `clock` (N,) is the scene's own time at each."""
    rows = around.near(case.posed, clock, judge.reach + case.ledger.limit)
    if rows.stop > rows.start:
        near = case.part(rows)
        judge.judge(near._replace(posed=around.seen(near.posed, clock[rows])))


def _body_verdict(ledger: Ledger, motion: ShownMotion, moments: Moments) -> BodyVerdict:
    touching = np.array(sorted(ledger.touching), np.int64)
    assisted = motion.assisted[moments.second[touching]]
    deepest = 0.0 if ledger.least is None else max(-ledger.least.clearance, 0.0)
    return BodyVerdict(
        touching=len(touching),
        touching_assisted=int(np.count_nonzero(assisted)),
        deepest=deepest if len(touching) else 0.0,
        least=ledger.least,
        contacts=ledger.contacts,
        tolerance=ledger.tolerance,
    )
