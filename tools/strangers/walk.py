"""A walk through a scene, exported in every format, and where its joints are at some frames."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.experiment.crossing import controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.export.animation import Animation
from elbowroom.export.formats import FORMATS, Wishes
from elbowroom.export.writers import WRITERS
from elbowroom.world.scene import Scene

SCENE = "shapes"
_SHOWN = 12  # frames that are compared


@dataclass(frozen=True, eq=False)
class Walk:
    """What was exported."""

    folder: Path
    avatar: Humanoid
    scene: Scene
    animation: Animation
    frames: list[int]  # that are compared

    def file(self, ending: str) -> Path:
        """The file of a format."""
        return self.folder / f"walk.{ending}"

    @property
    def times(self) -> list[float]:
        """Seconds of the frames that are compared."""
        return [frame / self.animation.fps for frame in self.frames]

    @property
    def names(self) -> list[str]:
        """All joints."""
        return list(self.animation.skeleton.names)

    def away(self, places: object) -> float:
        """Millimetres between our joints and somebody's places (frames, joints, 3), at the worst one."""
        found: NDArray[np.float64] = np.asarray(places, np.float64)
        ours = self.animation.joints_in_world()[self.frames]
        return 1e3 * float(np.linalg.norm(found - ours, axis=-1).max())


def exported_walk(folder: Path) -> Walk:
    """Walk through the scene and write every format into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    avatar = Humanoid.default()
    scene = Scene.load(SCENE)
    controller = controller_for(avatar, scene, CrossingSettings())
    with Recorder(folder / "walk.elbow", controller) as recorder:
        run_crossing(controller, CrossingSettings(), recorder.append)
    animation = Animation.of(Recording(folder / "walk.elbow"), avatar)
    for ending, chosen in FORMATS.items():
        written = WRITERS[ending](animation, avatar, chosen.layout(Wishes()))
        (folder / f"walk.{ending}").write_bytes(written.data)
    frames = np.unique(np.linspace(0, len(animation) - 1, _SHOWN).astype(int)).tolist()
    return Walk(folder, avatar, scene, animation, frames)
