"""The collision body as a surface, for avatars that have none, and to look at it."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.skin import Skin
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_AROUND, _ALONG = 16, 5  # points round a capsule, rings on each of its half balls


def capsule_skin(humanoid: Humanoid) -> Skin:
    """The capsules as a skin whose every vertex rides on one joint."""
    capsules = humanoid.capsules
    parts = [_capsule(*row) for row in zip(capsules.starts, capsules.ends, capsules.radii, strict=True)]
    counts = np.array([len(points) for points, _ in parts])
    first = np.cumsum(counts) - counts
    joints = np.repeat(capsules.joints, counts)[:, None]
    return Skin(
        triangles=np.concatenate([triangles + at for (_, triangles), at in zip(parts, first, strict=True)]),
        joints=joints,
        weights=np.ones(joints.shape),
        offsets=np.concatenate([points for points, _ in parts])[:, None],
        left_out=0,
    )


def _capsule(start: Floats, end: Floats, radius: float) -> tuple[Floats, NDArray[np.int64]]:
    """Points (V, 3) and triangles (T, 3) of one capsule."""
    along = end - start
    turn = quaternion.between([0.0, 1.0, 0.0], along if np.linalg.norm(along) > 1e-9 else [0.0, 1.0, 0.0])
    rise = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * _ALONG)
    round_ = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    ring = np.stack([np.cos(round_), np.zeros(_AROUND), np.sin(round_)], axis=1)
    ball = np.cos(rise)[:, None, None] * ring + np.sin(rise)[:, None, None] * np.array([0.0, 1.0, 0.0])
    places = np.where((rise > 0.0)[:, None, None], end, start) + radius * quaternion.rotate(turn, ball)
    rows, columns = np.meshgrid(np.arange(2 * _ALONG - 1), np.arange(_AROUND), indexing="ij")
    beside = (columns + 1) % _AROUND
    a, b = rows * _AROUND + columns, rows * _AROUND + beside
    corners = [[a, b, a + _AROUND], [b, b + _AROUND, a + _AROUND]]
    triangles = np.concatenate([np.stack([corner.ravel() for corner in three], axis=1) for three in corners])
    return places.reshape(-1, 3), triangles
