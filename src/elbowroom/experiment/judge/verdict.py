"""The judge's verdict on a shown motion: what touches, how near it comes, how smoothly it moves."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.recordings.recording import Recording
from elbowroom.experiment.judge.capsule_judge import CapsuleJudge
from elbowroom.experiment.judge.ledger import Contact, Ledger, Nearness
from elbowroom.experiment.judge.mesh_judge import MeshJudge
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.obstacles import surroundings_of
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.self_judge import SelfJudge
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.skin import Skin, skin_of
from elbowroom.experiment.judge.smoothness import Smoothness, smoothness
from elbowroom.experiment.judge.soles import Soles
from elbowroom.world.scene import Scene

_AT_ONCE = 240  # poses

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
    seconds: float  # of motion
    capsules: BodyVerdict
    mesh: BodyVerdict | None  # None: not asked for, or the avatar has none
    itself: BodyVerdict  # the collision body against itself: parts in each other deeper than in the natural walk
    mesh_note: str  # why there is no mesh, else empty
    triangles: int  # of the mesh that were judged
    triangles_left_out: int  # moved by springs, or rigid things on a skinned body
    smoothness: dict[str, Smoothness]

    @property
    def clean(self) -> bool:
        """Whether no obstacle is touched; what the body does to itself is a figure of its own."""
        return self.capsules.touching == 0 and (self.mesh is None or self.mesh.touching == 0)


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
    chosen = settings or JudgeSettings()
    surroundings, poser = surroundings_of(scene), Poser(humanoid)
    skin, note = skin_of(humanoid) if chosen.mesh else (None, "not asked for")
    moments = motion.moments(chosen.rate)
    of_capsules, of_mesh = Ledger(chosen.capsule_tolerance), Ledger(chosen.mesh_tolerance)
    of_itself = Ledger(chosen.self_tolerance)
    capsule_judges = [CapsuleJudge(humanoid, around.obstacles) for around in surroundings]
    self_judge, soles = SelfJudge(humanoid), Soles(humanoid, poser, motion, floors=math.isinf(scene.obstacles.ground))
    mesh_judges = (
        [] if skin is None else [MeshJudge(skin, humanoid.skeleton, around.obstacles) for around in surroundings]
    )
    for first in range(0, len(moments.times), _AT_ONCE):
        some = moments.part(slice(first, first + _AT_ONCE))
        posed = poser.at(motion, some)
        times = motion.scene_times(some)
        bodies, surfaces = (
            [around.seen(body, times) for around in surroundings]
            for body in (soles.raised(posed, some), posed if skin is None else soles.raised(posed, some, skin))
        )
        for view, capsule_judge in zip(bodies, capsule_judges, strict=True):
            capsule_judge.judge(view, some.times, first, of_capsules)
        self_judge.judge(posed, some.times, first, of_itself)
        for view, mesh_judge in zip(surfaces, mesh_judges, strict=bool(mesh_judges)):
            mesh_judge.judge(view, some.times, first, of_mesh)
        if progress is not None:
            progress(float(some.times[-1]))
    return _verdict(motion, moments, (skin, note), of_capsules, of_itself, of_mesh)


def _verdict(
    motion: ShownMotion,
    moments: Moments,
    surface: tuple[Skin | None, str],
    capsules: Ledger,
    itself: Ledger,
    mesh: Ledger,
) -> Verdict:
    skin, note = surface
    return Verdict(
        frames=len(motion),
        poses=len(moments.times),
        seconds=float(motion.times[-1] - motion.times[0]),
        capsules=_body_verdict(capsules, motion, moments),
        mesh=None if skin is None else _body_verdict(mesh, motion, moments),
        itself=_body_verdict(itself, motion, moments),
        mesh_note=note,
        triangles=0 if skin is None else len(skin.triangles),
        triangles_left_out=0 if skin is None else skin.left_out,
        smoothness=smoothness(motion),
    )


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
