"""Added postures: within limits, evenly spread, the same each time, free where they are wanted, and few."""

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, clamp
from elbowroom.planning.exact.lattice.drawing import drawn_postures
from elbowroom.planning.exact.refine.sampling import Pool, chosen


@pytest.mark.parametrize("group", LOCAL_GROUPS)
def test_drawn_postures_keep_the_limits_and_repeat(group: DofGroup) -> None:
    goal = np.zeros(group.size)
    drawn = drawn_postures(group, goal, 400, 0.5)
    assert drawn.shape == (400, group.size)
    np.testing.assert_allclose(drawn, clamp(group, drawn), rtol=0.0, atol=1e-12)
    assert np.array_equal(drawn, drawn_postures(group, goal, 400, 0.5))
    assert np.all(np.abs(drawn[:200] - goal) <= 0.5 + 1e-12)


def test_they_fill_the_joints_range_evenly() -> None:
    """No corner of the elbow's and the flexion's range stays empty: of 8 x 8 cells fewer than by chance are."""
    drawn = drawn_postures(DofGroup.LEFT_ARM, np.zeros(4), 512, 0.0)[256:]
    cells = [np.histogram2d(drawn[:, a], drawn[:, b], 8)[0] for a, b in ((0, 3), (2, 3))]
    assert all((cell == 0).sum() <= 64 * np.exp(-4.0) + 4 for cell in cells)


def test_the_cheapest_that_differ_are_chosen() -> None:
    rng = np.random.default_rng(0)
    postures, costs, known = rng.uniform(-1, 1, (200, 3)), rng.uniform(0, 1, 200), rng.uniform(-1, 1, (5, 3))
    costs[rng.random(200) < 0.3] = np.inf
    taken = chosen(postures, costs, known, 0.4, 12)
    assert np.all(np.isfinite(costs[taken]))
    assert np.all(np.diff(costs[taken]) >= 0.0)
    together = np.concatenate([known, postures[taken]])
    for n in range(len(known), len(together)):
        assert np.linalg.norm(together[:n] - together[n], axis=1).min() >= 0.4
    if len(taken) < 12:  # whatever is left is like one that is there
        left = [n for n in range(200) if n not in taken and np.isfinite(costs[n])]
        assert all(np.linalg.norm(together - postures[n], axis=1).min() < 0.4 for n in left)


def test_a_pool_is_bounded_and_forgets_the_oldest() -> None:
    pool = Pool(2, 4)
    assert not pool.add(np.empty((0, 2)))
    for k in range(7):
        assert pool.add(np.full((1, 2), float(k)))
    assert pool.postures[:, 0].tolist() == [3.0, 4.0, 5.0, 6.0]
