"""What planning calls cost while a user really steers: each command a little different from the one before."""

import gc
import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from time import thread_time_ns
from typing import Any, NamedTuple

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.plans.desk import ImmediateDesk, Job
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.plans.wayfinder import Answer
from elbowroom.experiment.bench.settings import SteerSettings
from elbowroom.experiment.bench.steer_scenes import SteeredScene, steered_scenes, wanted_way
from elbowroom.experiment.crossing import DT, start_for, warm_up

_STILL = 0.05  # m/s: a user who wants less stands


class _Call(NamedTuple):
    """One planning call."""

    milliseconds: float  # of processor time
    checks: int  # of root and upper body
    nodes: int  # of the upper body


@dataclass(frozen=True)
class SteerCosts:
    """What steering through a scene, or through all of them, came to."""

    scene: str
    calls: int
    median_ms: float  # of processor time
    p99_ms: float
    worst_ms: float
    median_checks: float
    worst_checks: int
    median_nodes: float
    worst_nodes: int
    seconds: float  # of steering
    stuck_seconds: float
    touching_frames: int
    progress: float  # share of the way asked for that was made good


@dataclass(frozen=True)
class SteerReport:
    """All figures."""

    settings: SteerSettings
    scenes: tuple[SteerCosts, ...]
    overall: SteerCosts

    def as_dict(self) -> dict[str, Any]:
        """Settings and figures."""
        return asdict(self)


class _TimedDesk(ImmediateDesk):
    """Plans at once, and remembers what that cost."""

    def __init__(self) -> None:
        super().__init__()
        self.calls: list[_Call] = []

    def submit(self, job: Job) -> None:
        """Do the job."""
        super().submit(lambda: self._timed(job))

    def _timed(self, job: Job) -> Answer | None:
        began = thread_time_ns()
        answer = job()
        spent = 1e-6 * (thread_time_ns() - began)
        if answer is not None:
            self.calls.append(_Call(spent, answer.root.checks + answer.local.checks, answer.local.nodes))
        return answer


class _Walked(NamedTuple):
    """How a walk under a user's hand went."""

    calls: list[_Call]
    frames: int
    stuck: int  # frames
    touching: int  # frames
    made: float  # metres of the way asked for
    asked: float  # metres


def run(settings: SteerSettings, tick: Callable[[int], None] = lambda _: None) -> SteerReport:
    """Steer through the scenes; `tick` hears how many walks are done."""
    humanoid, scenes = Humanoid.default(), steered_scenes(settings.scenes)
    warm_up(Controller(humanoid, scenes[0].scene))
    gc.freeze()  # as a server does: kernels and libraries are no garbage
    walks: list[list[_Walked]] = [[] for _ in scenes]
    for done, (number, seed) in enumerate(product(range(len(scenes)), range(settings.rounds)), 1):
        walks[number].append(steered_walk(humanoid, scenes[number], settings.seconds, seed))
        tick(done)
    rows = tuple(_costs(steered.name, own) for steered, own in zip(scenes, walks, strict=True))
    return SteerReport(settings, rows, _costs("all", [walk for own in walks for walk in own]))


def amount(settings: SteerSettings) -> int:
    """How many walks there will be."""
    return settings.rounds * len(steered_scenes(settings.scenes))


def steered_walk(humanoid: Humanoid, steered: SteeredScene, seconds: float, seed: int = 0) -> _Walked:
    """Steer an avatar through a scene until the finish, at most for `seconds`; from the start that the seed draws."""
    desk, hand = _TimedDesk(), steered.hand(steered.route)
    controller = Controller(humanoid, steered.scene, start=start_for(steered.scene, seed), ahead=Lookahead(desk=desk))
    controller.prepare()
    stuck, touching, made, asked, frames = 0, 0, 0.0, 0.0, round(seconds / DT)
    for number in range(frames):
        before = controller.root
        if steered.scene.finished(before):
            frames = number
            break
        command = hand(number * DT, before.x, before.z)
        frame = controller.step(command, DT)
        stuck, touching = stuck + frame.stuck, touching + frame.touching
        x, z = wanted_way(command, before.heading)
        if (speed := math.hypot(x, z)) > _STILL:
            made += ((controller.root.x - before.x) * x + (controller.root.z - before.z) * z) / speed
            asked += speed * DT
    return _Walked(desk.calls, frames, stuck, touching, made, asked)


def _costs(name: str, walks: Sequence[_Walked]) -> SteerCosts:
    times, checks, nodes = np.array([call for walk in walks for call in walk.calls]).T
    return SteerCosts(
        scene=name,
        calls=len(times),
        median_ms=float(np.median(times)),
        p99_ms=float(np.percentile(times, 99)),
        worst_ms=float(times.max()),
        median_checks=float(np.median(checks)),
        worst_checks=int(checks.max()),
        median_nodes=float(np.median(nodes)),
        worst_nodes=int(nodes.max()),
        seconds=DT * sum(walk.frames for walk in walks),
        stuck_seconds=DT * sum(walk.stuck for walk in walks),
        touching_frames=sum(walk.touching for walk in walks),
        progress=sum(walk.made for walk in walks) / sum(walk.asked for walk in walks),
    )
