"""After a contact: the limbs free themselves where the root cannot lead away."""

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.plans.rehearsal import partial_motions, standing_path
from elbowroom.experiment.crossing import controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.planning.root.path import RootPath
from elbowroom.world.scene import Scene


def test_partial_motions_keep_whole_groups() -> None:
    rng = np.random.default_rng(0)
    upper = rng.normal(size=LOCAL)
    motion = upper + rng.uniform(0.1, 1.0, (4, LOCAL))
    parts = partial_motions(motion, upper)
    assert len(parts) == 7
    np.testing.assert_array_equal(parts[0], motion)
    groups = [columns_of(group) for group in LOCAL_GROUPS]
    moved = {tuple(bool(np.any(part[:, group] != upper[group])) for group in groups) for part in parts}
    assert len(moved) == 7
    assert all(any(row) for row in moved)
    waist, head = LOCAL_GROUPS.index(DofGroup.WAIST), LOCAL_GROUPS.index(DofGroup.HEAD)
    assert all(row[waist] == row[head] for row in moved)
    for part in parts:
        assert np.all((part == motion) | (part == upper))


def test_no_motion_is_no_way_out() -> None:
    upper = np.ones(LOCAL)
    assert partial_motions(np.tile(upper, (4, 1)), upper) == []


def test_a_standing_path_stands() -> None:
    walk = RootPath(2.0, 0.15, np.ones((6, ROOT_STATE)))
    root = np.array([1.0, 2.0, 0.3, 1.0, 0.2, 0.1, 4.2])
    still = standing_path(walk, root)
    np.testing.assert_array_equal(still.times, walk.times)
    np.testing.assert_array_equal(still.states, np.tile([1.0, 2.0, 0.3, 0.0, 0.0, 0.0, 4.2], (6, 1)))


@pytest.mark.parametrize(
    ("scene", "queue", "seed"), [("a", 6, 11), ("a", 5, 16), ("b", 6, 3), ("b", 5, 16), ("d", 5, 3)]
)
def test_nobody_is_trapped_between_two_obstacles(scene: str, queue: int, seed: int) -> None:
    settings = CrossingSettings("figure6", queue_size=queue, seed=seed)
    controller = controller_for(Humanoid.default(), Scene.load(scene), settings)
    result = run_crossing(controller, settings)
    assert result.passed
    assert result.least_clearance >= 0.0
