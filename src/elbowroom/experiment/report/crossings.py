"""Successful crossings, walked once more to be drawn."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.control.frame import Frame
from elbowroom.experiment.crossing import controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.opened import Openable
from elbowroom.experiment.parallel import Workers
from elbowroom.experiment.table1.table import Table1
from elbowroom.experiment.table1.tasks import AvatarFile, NamedScene, open_avatar, open_scene

Floats = NDArray[np.float64]

_SPACING = 0.55  # metres between the postures drawn


@dataclass(frozen=True, eq=False)
class DrawnCrossing:
    """One crossing, as much of it as a picture needs."""

    scene: str  # name or file, as `open_scene` takes it
    settings: CrossingSettings
    straight: bool
    seconds: float
    roots: Floats  # (frames, 2) x, z of the root, metres
    stuck_at: Floats  # (times stuck, 2) where it got stuck
    postures: Floats  # (postures, C, 6) capsule end points in the world
    radii: Floats  # (C,) metres
    groups: tuple[DofGroup, ...]  # (C,)


@dataclass(frozen=True)
class DrawTask:
    """Walk a trial again and keep what its picture needs."""

    scene: str
    avatar: Path | None
    settings: CrossingSettings

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """Avatar and scene."""
        return AvatarFile(self.avatar), NamedScene(self.scene)

    def run(self) -> DrawnCrossing:
        """The crossing."""
        humanoid, scene = open_avatar(self.avatar), open_scene(self.scene)
        frames: list[Frame] = []

        def keep(frame: Frame, dt: float) -> None:
            del dt
            frames.append(frame)

        result = run_crossing(controller_for(humanoid, scene, self.settings), self.settings, keep)
        chosen = _spaced(frames, scene.start.heading)
        states = np.stack([frame.root for frame in chosen])
        segments = posture_capsules(body_model(humanoid), np.stack([frame.q for frame in chosen]), states)
        begins = [now for before, now in pairwise(frames) if now.stuck and not before.stuck]
        return DrawnCrossing(
            scene=self.scene,
            settings=self.settings,
            straight=result.straight,
            seconds=frames[-1].time,
            roots=np.stack([frame.root[:2] for frame in frames]),
            stuck_at=np.array([frame.root[:2] for frame in begins]).reshape(-1, 2),
            postures=np.moveaxis(segments, 2, 0).astype(np.float64),
            radii=humanoid.capsules.radii,
            groups=humanoid.capsules.groups,
        )


def successful_crossings(table: Table1, workers: Workers) -> dict[str, DrawnCrossing]:
    """The best crossing of every scene that has one, by the scene's name: straight ones first, then the quickest."""
    names = {open_scene(scene).name: scene for scene in table.settings.scenes}
    best = {name: _best([trial for trial in table.trials if trial["scene"] == name]) for name in names}
    tasks = [
        DrawTask(names[name], table.settings.avatar, _settings(trial, table.settings.limit))
        for name, trial in best.items()
        if trial is not None
    ]
    drawn = [crossing for _, crossing in workers.run(tasks)]
    return {open_scene(crossing.scene).name: crossing for crossing in drawn}


def _best(trials: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    passed = [trial for trial in trials if trial["passed"]]
    return min(passed, key=lambda trial: (trial["stuck_times"], trial["passed_time_s"]), default=None)


def _settings(trial: dict[str, Any], limit: float) -> CrossingSettings:
    return CrossingSettings(trial["planner"], trial["queue_size"], trial["seed"], limit)


def _spaced(frames: Sequence[Frame], heading: float) -> list[Frame]:
    """The frames that first reach every next half metre or so of the way ahead."""
    ahead = np.array([np.sin(heading), np.cos(heading)])
    way = np.maximum.accumulate([float((frame.root[:2] - frames[0].root[:2]) @ ahead) for frame in frames])
    marks = np.arange(0.0, way[-1] + 1e-9, _SPACING)
    return [frames[int(np.searchsorted(way, mark))] for mark in marks]
