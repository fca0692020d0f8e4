"""What many avatars cost on one core: memory and milliseconds to make each, and how many of them keep 60 Hz."""

import gc
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from time import thread_time_ns
from typing import Any

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.experiment.bench.settings import CrowdSettings
from elbowroom.experiment.crossing import start_for
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

RATE = 60  # frames a second
_CYCLE = 36  # frames from one new end of a plan to the next: avatars set out one after the other within so many
_WALKING, _STANDING = Command(forward=1.0), Command()


@dataclass(frozen=True)
class CrowdCost:
    """A crowd in one scene; all of it on one thread."""

    what: str
    avatars: int
    made_ms: float  # to make one more avatar of a kind that is known, processor time
    own_mb: float  # memory that one more of them has of its own after walking, in Python and in arrays
    frame_ms: float  # mean processor time of a frame of all
    frame_p99_ms: float
    frame_worst_ms: float
    at_60_hz: int  # avatars that the mean leaves time for


@dataclass(frozen=True)
class CrowdReport:
    """All figures."""

    settings: CrowdSettings
    costs: tuple[CrowdCost, ...]

    def as_dict(self) -> dict[str, Any]:
        """Settings and figures."""
        return asdict(self)


def amount(settings: CrowdSettings) -> int:
    """How many crowds there will be."""
    return len(_KINDS) * len(settings.avatars)


def run(settings: CrowdSettings, tick: Callable[[int], None] = lambda _: None) -> CrowdReport:
    """Measure crowds of each size that walk in the open, walk scene D, and stand."""
    humanoid = Humanoid.default()
    costs: list[CrowdCost] = []
    for what, (name, command) in _KINDS.items():
        scene = Scene.load(name)
        first = _made(humanoid, scene, 1)  # what all of them share is made, and stays: the maps of the scene too
        _walk(first, command, RATE)
        for count in settings.avatars:
            costs.append(_cost(what, humanoid, scene, count, command, settings))
            tick(len(costs))
    return CrowdReport(settings, tuple(costs))


_KINDS = {
    "walking in the open": ("empty", _WALKING),
    "walking scene D": ("d", _WALKING),
    "standing": ("empty", _STANDING),
}


def _cost(
    what: str, humanoid: Humanoid, scene: Scene, count: int, command: Command, settings: CrowdSettings
) -> CrowdCost:
    gc.collect()
    tracemalloc.start()
    before, _ = tracemalloc.get_traced_memory()
    crowd = _made(humanoid, scene, count)
    _walk(crowd, command, _CYCLE)
    gc.collect()
    own = (tracemalloc.get_traced_memory()[0] - before) / count
    tracemalloc.stop()
    began = thread_time_ns()
    crowd = _made(humanoid, scene, count)
    made = (thread_time_ns() - began) / count
    _walk(crowd, command, round(settings.settle * RATE))
    spent = np.array(list(_frames(crowd, command, round(settings.seconds * RATE)))) / 1e6
    mean = float(spent.mean())
    return CrowdCost(
        what, count, made / 1e6, own / 1e6, mean, float(np.percentile(spent, 99)), float(spent.max()),
        int(1e3 / RATE / mean * count),
    )  # fmt: skip


def _made(humanoid: Humanoid, scene: Scene, count: int) -> list[Controller]:
    """So many avatars, each from a start of its own; they are in each other's way only on paper."""
    starts: Sequence[RootState] = [start_for(scene, seed) for seed in range(count)]
    made = [Controller(humanoid, replace(scene, start=start)) for start in starts]
    for controller in made:
        controller.prepare()
    return made


def _walk(crowd: list[Controller], command: Command, frames: int) -> None:
    for _ in _frames(crowd, command, frames, setting_out=True):
        pass


def _frames(crowd: list[Controller], command: Command, frames: int, *, setting_out: bool = False) -> Iterator[int]:
    """Nanoseconds of processor time of each frame of all; at first they set out one after the other."""
    for frame in range(frames + _CYCLE * setting_out):
        began = thread_time_ns()
        for number, controller in enumerate(crowd):
            waits = setting_out and frame * len(crowd) < number * _CYCLE
            if controller.scene.finished(controller.root):
                controller.reset()
            controller.step(_STANDING if waits else command, 1.0 / RATE)
        yield thread_time_ns() - began
