"""A scene and a whole run as they are exported, and where the things in them are at some times."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.export.avatar_glb import avatar_glb
from elbowroom.export.formats import RootMotion
from elbowroom.export.place import place_glb, with_place
from elbowroom.export.place_x3d import place_x3d
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.tracks.moving import Repeat
from elbowroom.world.obstacles.triangles import triangles_of
from elbowroom.world.scene import Scene
from strangers.walk import Walk

Floats = NDArray[np.float64]

GLB, X3D, RUN = "scene .glb", "scene .x3d", "run .glb"
_TIMES = (0.0, 0.8, 2.9, 4.4)  # seconds at which what moves is compared in the X3D of a scene


@dataclass(frozen=True, eq=False)
class Place:
    """What was exported, and where its things are: as the eight corners of boxes round them, along their own axes."""

    scene: Scene
    files: Mapping[str, Path]
    walk: Walk  # of the run

    @property
    def times(self) -> tuple[float, ...]:
        """Seconds."""
        return _TIMES

    @property
    def run_times(self) -> list[float]:
        """The scene's own time at the frames of the run that are compared."""
        times: list[float] = self.walk.animation.clock[self.walk.frames].tolist()
        return times

    def corners(self, time: float) -> dict[str, Floats]:
        """The corners (8, 3) of all things at a time, by their names."""
        found = {}
        for name, shape, center, turn in self.scene.obstacles:
            found[name] = center + quaternion.rotate(turn, _corners(triangles_of(shape)))
        for track in self.scene.obstacles.moving.tracks:
            centers, yaws = track.poses([time])
            turn = quaternion.about_axis(1, float(yaws[0]))
            found[track.name] = centers[0] + quaternion.rotate(turn, _corners(triangles_of(track.shape)))
        return found

    def away(self, time: float, found: Mapping[str, ArrayLike]) -> float:
        """Millimetres between our corners and somebody's, at the worst thing; a thing that is not there is far away."""
        worst = 0.0
        for name, corners in self.corners(time).items():
            theirs = np.asarray(found.get(name, [[1e3, 1e3, 1e3]]), np.float64)
            gaps = np.linalg.norm(corners[:, None] - theirs[None], axis=-1)
            worst = max(worst, float(gaps.min(axis=1).max()), float(gaps.min(axis=0).max()))
        return 1e3 * worst

    def fractions(self, time: float) -> dict[str, float]:
        """How far each interpolator of the X3D is at a time, by its name there."""
        told: dict[str, float] = {}
        for number, track in enumerate(self.scene.obstacles.moving.tracks):
            round_trip = track.duration * (2.0 if track.repeat is Repeat.PINGPONG else 1.0)
            share = time % round_trip / round_trip
            told |= {f"moving_{number}_translation": share, f"moving_{number}_rotation": share}
        return told


def _corners(triangles: Floats) -> Floats:
    points = triangles.reshape(-1, 3)
    return np.array(list(product(*zip(points.min(axis=0), points.max(axis=0), strict=True))))


def exported_place(walk: Walk) -> Place:
    """Write a scene, and the run in it, into the folder of the walk."""
    scene = walk.scene
    files = {GLB: walk.folder / "scene.glb", X3D: walk.folder / "scene.x3d", RUN: walk.folder / "run.glb"}
    files[GLB].write_bytes(place_glb(scene))
    files[X3D].write_bytes(place_x3d(scene))
    alone = avatar_glb(walk.animation, walk.avatar, RootMotion.HIPS)
    files[RUN].write_bytes(with_place(alone, scene, walk.animation))
    return Place(scene, files, walk)
