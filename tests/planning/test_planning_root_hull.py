"""The rectangles round a stride: they hold every stride, and leave out no contact."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import leg_capsules
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.planning.root.legs.hull import boxes_below, to_check
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.motion import MotionBounds, dense_states, steer, stopping_states
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

AVATAR = Humanoid.default()
BOUNDS = MotionBounds(2.5, 2.0, 3.0, 14.0)
SPACING = 0.0125


def walks(seed: int, count: int) -> list[NDArray[np.float64]]:
    """Random ways of eight key states among the obstacles of the paper's scenes."""
    rng, found = np.random.default_rng(seed), []
    for _ in range(count):
        states = np.zeros((9, ROOT_STATE))
        states[0] = RootState(*rng.uniform([-0.6, 0, -3, -0.7, -0.6, -2, 0], [0.6, 4.5, 3, 2, 0.6, 2, 1]))
        steer(states, rng.uniform([-0.7, -0.6, -2.5], [2.2, 0.6, 2.5]), 0.15, BOUNDS)
        found.append(states)
    return found


def least_by_owner(
    body: LowerBody, near: Nearby, found: tuple[NDArray[np.float64], NDArray[np.int64]]
) -> NDArray[np.float64]:
    """The least clearance of posed legs from all boxes over each key interval's states."""
    least = np.full(8, np.inf)
    clear = clearance(leg_capsules(body.model, found[0]), body.radii, near)
    np.minimum.at(least, found[1] - 1, clear)
    return least


def test_no_contact_is_left_out_and_much_is() -> None:
    every, looked_at, total = np.ones(8, np.bool_), 0, 0
    for scene in "abcd":
        obstacles = Scene.load(scene).obstacles
        body, near = LowerBody(AVATAR, obstacles), obstacles.standing
        for states in walks(ord(scene), 40):
            moving, stopping = to_check(states, 0.15, 3.0, 14.0, 0.01, body.hull, body.boxes)
            shown = least_by_owner(body, near, dense_states(states, 0.15, SPACING, every))
            stops = least_by_owner(body, near, stopping_states(states, 0.15, BOUNDS, SPACING, every))
            assert not np.any(~moving & (shown < 0.01))
            assert not np.any(~stopping & (stops < 0.01))
            looked_at, total = looked_at + int(moving.sum()) + int(stopping.sum()), total + 16
    assert 0.05 * total < looked_at < 0.7 * total


def test_a_stride_stays_in_its_rectangle() -> None:
    hull = LowerBody(AVATAR, Scene.load("empty").obstacles).hull
    rng = np.random.default_rng(1)
    states = np.zeros((400, 7))
    states[:, 3:] = rng.uniform([-0.7, -0.7, -2.5, 0.0], [2.3, 0.7, 2.5, 1.0], (400, 4))
    states[200:, 4:6] *= 0.005 / 0.7, 0.01 / 2.5  # nearly straight: as straight
    body = LowerBody(AVATAR, Scene.load("empty").obstacles)
    ends = leg_capsules(body.model, states).reshape(len(body.radii), 2, 3, 400)
    cell = np.ceil(np.abs(states[:, 3:6]) / hull.cell).astype(int)
    cell[200:, 1:] = 0
    side, behind, ahead = hull.extents[tuple(cell.T)].T
    radii = body.radii[:, None, None]
    assert np.all(np.abs(ends[:, :, 0]) + radii <= side)
    assert np.all(ends[:, :, 2] + radii <= ahead)
    assert np.all(ends[:, :, 2] - radii >= -behind)


def test_only_what_is_low_enough_covers_the_ground() -> None:
    turn = np.array([[0.0, 0.0, np.sin(0.4), np.cos(0.4)]])  # leans over to the side
    plank = Obstacles.boxes(np.array([[0.0, 1.0, 2.0]]), turn, np.array([[0.05, 1.0, 0.3]]))
    rng: Any = np.random.default_rng(2)
    inside = rng.uniform(-1.0, 1.0, (4000, 3)) * plank.half_sizes
    angle = 0.8
    x, y = (
        inside[:, 0] * np.cos(angle) - inside[:, 1] * np.sin(angle),
        inside[:, 0] * np.sin(angle) + inside[:, 1] * np.cos(angle),
    )
    for height in (0.5, 0.9, 1.3, 5.0):
        boxes = boxes_below(plank.corners, height)
        low = y + 1.0 <= height
        assert boxes.least[0, 0] <= x[low].min() < boxes.least[0, 0] + 0.05
        assert boxes.most[0, 0] >= x[low].max() > boxes.most[0, 0] - 0.05
        assert len(boxes.corners[0]) == 24
