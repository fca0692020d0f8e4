"""The trials of the experiment, each a task for a process of its own."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Any

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.experiment.beside import BesideDesk
from elbowroom.experiment.crossing import DT, controller_for, run_timed_crossing, start_for, warm_up
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.opened import Openable, opened
from elbowroom.experiment.scripted_user import FORWARD
from elbowroom.experiment.table1.settings import Table1Settings
from elbowroom.experiment.trial_log import digest
from elbowroom.world.scene import Scene

CANNED = "canned"


@dataclass(frozen=True)
class NamedScene:
    """A stock scene by its name, or a scene file."""

    name: str

    def open(self) -> Scene:
        """Read it."""
        return Scene.load(self.name)


@dataclass(frozen=True)
class AvatarFile:
    """An avatar's file, None for the stock one."""

    path: Path | None

    def open(self) -> Humanoid:
        """Read it."""
        return Humanoid.default() if self.path is None else Humanoid.load(self.path)


@dataclass(frozen=True)
class CrossingTask:
    """One crossing trial."""

    scene: str
    avatar: Path | None
    settings: CrossingSettings

    @property
    def key(self) -> str:
        """By what the trial log knows it: the scene's content, not only its name, is part of it."""
        chosen = self.settings
        return (
            f"crossing {scene_key(self.scene)} {chosen.planner} {chosen.queue_size} {chosen.seed}"
            + " live" * chosen.live
        )

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """Avatar and scene."""
        return AvatarFile(self.avatar), NamedScene(self.scene)

    def run(self) -> dict[str, Any]:
        """The row of the trial, and what each of its frames and plans cost."""
        chosen = self.settings
        desk = BesideDesk(DT) if chosen.live else None
        controller = controller_for(open_avatar(self.avatar), open_scene(self.scene), chosen, desk=desk)
        warm_up(controller)
        result, times = run_timed_crossing(controller, chosen, desk=desk)
        return asdict(result) | {
            "frame_ms": times.frame_ms.round(2).tolist(),
            "plan_ms": times.plan_ms.round(2).tolist(),
        }


@dataclass(frozen=True)
class CannedTask:
    """The walk of a crossing trial without planning of the upper body: what it touches."""

    scene: str
    avatar: Path | None
    seed: int
    limit: float

    @property
    def key(self) -> str:
        """By what the trial log knows it."""
        return f"{CANNED} {scene_key(self.scene)} {self.seed}"

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """Avatar and scene."""
        return AvatarFile(self.avatar), NamedScene(self.scene)

    def run(self) -> dict[str, Any]:
        """How many frames of it touch, and how deep, in metres."""
        scene = open_scene(self.scene)
        start = start_for(scene, self.seed)
        controller = Controller(open_avatar(self.avatar), scene, assist=False, start=start)
        frames = touching = 0
        deepest = 0.0
        while not scene.finished(controller.root) and frames * DT < self.limit:
            frame = controller.step(FORWARD, DT)
            frames += 1
            touching += frame.touching
            deepest = max(deepest, -frame.clearance)
        reached = scene.finished(controller.root)
        return {
            "scene": scene.name,
            "seed": self.seed,
            "reached": reached,
            "frames": frames,
            "touching_frames": touching,
            "deepest": round(deepest, 6),
        }


def crossing_tasks(settings: Table1Settings) -> Iterator[CrossingTask]:
    """All trials: every cell gets its first seed, then every cell its second, and so on."""
    seeds = range(1, settings.seeds + 1)
    for seed, planner, scene, queue in product(seeds, settings.planners, settings.scenes, settings.queues):
        yield CrossingTask(
            scene, settings.avatar, CrossingSettings(planner, queue, seed, settings.limit, settings.live)
        )


def canned_tasks(settings: Table1Settings) -> Iterator[CannedTask]:
    """The walk without planning, from the same starts."""
    for seed, scene in product(range(1, settings.seeds + 1), settings.scenes):
        yield CannedTask(scene, settings.avatar, seed, settings.limit)


def open_scene(name: str) -> Scene:
    """A scene, opened once in a process."""
    return opened(NamedScene(name))


def open_avatar(path: Path | None) -> Humanoid:
    """The avatar, opened once in a process; the stock one for None."""
    return opened(AvatarFile(path))


@lru_cache(maxsize=64)
def scene_key(name: str) -> str:
    """The scene's name and content in short."""
    scene = open_scene(name)
    return f"{scene.name}@{digest(scene.to_dict())[:12]}"
