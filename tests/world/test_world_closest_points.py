"""Where a segment and boxes are closest: against the kernel's distances, and a scene of none."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import pairwise_clearance
from elbowroom.world.obstacles.closest_points import closest_points
from elbowroom.world.obstacles.obstacles import Obstacles


@given(seed=st.integers(0, 2**32 - 1))
def test_their_distance_is_the_kernels_and_they_lie_where_they_should(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turns = quaternion.normalize(rng.normal(size=(7, 4)))
    boxes = Obstacles.boxes(rng.uniform(-1, 1, (7, 3)), turns, rng.uniform(0.02, 0.6, (7, 3)))
    segment = rng.uniform(-1.5, 1.5, 6)
    if seed % 3 == 0:
        segment[3:] = segment[:3]  # a point
    on_segment, on_box = closest_points(segment, boxes.standing)
    found = np.linalg.norm(on_segment - on_box, axis=1)
    expected = pairwise_clearance(segment[None, :, None], np.zeros(1), boxes.standing)[0, :, 0]
    np.testing.assert_allclose(found, expected, atol=2e-5)
    inside = quaternion.rotate(quaternion.conjugate(boxes.rotations), on_box - boxes.centers)
    assert np.all(np.abs(inside) <= boxes.half_sizes + 1e-9)
    along = segment[3:] - segment[:3]
    share = ((on_segment - segment[:3]) @ along) / max(float(along @ along), 1e-12)
    np.testing.assert_allclose(on_segment, segment[:3] + share[:, None] * along, atol=1e-9)
    assert np.all((share > -1e-9) & (share < 1.0 + 1e-9))


def test_there_need_not_be_a_box() -> None:
    on_segment, on_box = closest_points(np.zeros(6), Obstacles().standing)
    assert on_segment.shape == on_box.shape == (0, 3)
