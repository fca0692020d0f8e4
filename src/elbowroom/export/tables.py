"""An animation as tables: every joint's place and rotation, frame by frame."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.export.animation import Animation
from elbowroom.export.formats import Layout
from elbowroom.export.layout import take_of
from elbowroom.formats.tables import write_csv, write_npz

_PLACE, _TURN = ("x", "y", "z"), ("qx", "qy", "qz", "qw")


def archive(animation: Animation, layout: Layout) -> bytes:
    """An `.npz` archive: the skeleton, the local rotations and translations of its nodes, and where they are."""
    take = take_of(animation, layout)
    every = np.arange(len(take.tree))
    turns, places = take.world(every)
    arrays: dict[str, NDArray[np.generic]] = {
        "times": _times(animation),  # (F,) seconds
        "names": np.array(take.tree.names),  # (n,)
        "parents": take.tree.parents,  # (n,) -1 for the root
        "offsets": take.tree.translations,  # (n, 3) of the rest pose, from the parent
        "rotations": take.rotations,  # (F, n, 4) local, xyzw
        "translations": take.translations,  # (F, n, 3) local
        "world_positions": places,  # (F, n, 3)
        "world_rotations": turns,  # (F, n, 4) xyzw
        "unit": np.array(layout.unit),  # metres
        "fps": np.array(animation.fps),
    }
    return write_npz(arrays)


def table(animation: Animation, layout: Layout) -> bytes:
    """A `.csv` table: the time, and each node's place and rotation in the world."""
    take = take_of(animation, layout)
    turns, places = take.world(np.arange(len(take.tree)))
    columns = {"time": _times(animation)}
    for node, name in enumerate(take.tree.names):
        columns |= {f"{name}.{axis}": places[:, node, i] for i, axis in enumerate(_PLACE)}
        columns |= {f"{name}.{part}": turns[:, node, i] for i, part in enumerate(_TURN)}
    return write_csv(columns)


def _times(animation: Animation) -> NDArray[np.float64]:
    times: NDArray[np.float64] = np.arange(len(animation)) / animation.fps
    return times
