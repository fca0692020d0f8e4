"""The generator's own distances against coal, and its search for self-contact."""

import coal
import numpy as np

from elbowroom.body.dof import LOCAL
from elbowroom.experiment.gauntlet.body_rows import BodyRows, joined, rows_of
from elbowroom.experiment.gauntlet.placing import Keepout, PlacedBox, pushed
from gauntlet_courses import stock


def test_gaps_equal_those_of_coal() -> None:
    rng = np.random.default_rng(0)
    for _ in range(300):
        turn, size = tuple(rng.uniform(-3, 3, 3).tolist()), tuple(rng.uniform(0.05, 1.5, 3).tolist())
        placed = PlacedBox("box", tuple(rng.uniform(-0.5, 0.5, 3).tolist()), turn, size)
        axes, radii = rng.uniform(-1.5, 1.5, (4, 6)), rng.uniform(0.01, 0.2, 4)
        gap = BodyRows(axes, radii, np.zeros(4)).gap(placed.row())
        wanted = min(coal_gap(axis, radius, placed.row()) for axis, radius in zip(axes, radii, strict=True))
        assert abs(gap - wanted) < 1e-6 if wanted > -0.9 * radii.min() else gap <= 0.0


def test_of_many_rows_the_gap_is_that_of_the_nearest() -> None:
    rng = np.random.default_rng(2)
    begins, radii = rng.uniform(-2.0, 2.0, (400, 3)), rng.uniform(0.02, 0.2, 400)
    begins[:200] = np.sort(begins[:200], axis=0)  # as a body walks; the others are scattered
    way = begins[:, 0].copy()
    rows = BodyRows(np.concatenate([begins, begins + rng.normal(0.0, 0.2, (400, 3))], axis=1), radii, way)
    alone = [BodyRows(rows.axes[i : i + 1], rows.radii[i : i + 1], rows.way[i : i + 1]) for i in range(400)]
    for _ in range(50):
        turn, size = tuple(rng.uniform(-3, 3, 3).tolist()), tuple(rng.uniform(0.05, 1.5, 3).tolist())
        box = PlacedBox("box", tuple(rng.uniform(-3.0, 3.0, 3).tolist()), turn, size).row()
        assert rows.gap(box) == min(row.gap(box) for row in alone)


def test_a_box_is_pushed_as_far_as_it_has_slack() -> None:
    rng = np.random.default_rng(3)
    begins = np.sort(rng.uniform(-1.0, 1.0, (90, 3)), axis=0)
    way = begins[:, 2].copy()
    rows = BodyRows(np.concatenate([begins, begins + 0.1], axis=1), np.full(90, 0.1), way)
    others = rows.every(4)
    keepout = Keepout(rows.pieces, others.pieces, 0.02, 0.03)
    for _ in range(50):
        direction = rng.normal(size=3)
        push, most = direction / np.linalg.norm(direction), float(rng.uniform(1.0, 4.0))
        turn, size = tuple(rng.uniform(-3, 3, 3).tolist()), tuple(rng.uniform(0.05, 0.5, 3).tolist())
        box = PlacedBox("box", tuple((-3.0 * push + 0.3 * rng.normal(size=3)).tolist()), turn, size).row()
        assert pushed(keepout, box, push, 0.0, most) == plainly_pushed(rows, others, box, push, most)


def plainly_pushed(rows: BodyRows, others: BodyRows, box: np.ndarray, push: np.ndarray, most: float) -> float:
    done = 0.0
    for _ in range(30):
        moved = np.concatenate([box[:3] + done * push, box[3:]])
        slack = min(rows.gap(moved) - 0.02, others.gap(moved) - 0.03) - 1e-3
        if slack < 1e-3:
            return done
        done += slack
        if done > most:
            return 0.0
    return done


def coal_gap(axis: np.ndarray, radius: float, row: np.ndarray) -> float:
    step = axis[3:] - axis[:3]
    length = float(np.linalg.norm(step))
    z = step / length
    x = np.cross(z, [1.0, 0.0, 0.0] if abs(z[0]) < 0.9 else [0.0, 1.0, 0.0])
    x /= np.linalg.norm(x)
    capsule_place = coal.Transform3s(np.stack([x, np.cross(z, x), z], axis=1), 0.5 * (axis[:3] + axis[3:]))
    box_place = coal.Transform3s(row[3:12].reshape(3, 3).T, row[:3])
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    axis_only = coal.Capsule(1e-9, length)
    coal.distance(axis_only, capsule_place, coal.Box(*(2.0 * row[12:])), box_place, request, result)
    return max(float(result.min_distance), 0.0) - radius


def test_rows_keep_what_capsules_are() -> None:
    rng = np.random.default_rng(1)
    segments, radii, way = rng.normal(size=(3, 6, 5)), rng.uniform(0.1, 0.2, 3), np.arange(5.0)
    rows = rows_of(segments, radii, way)
    assert rows.axes.shape == (15, 6)
    assert np.array_equal(rows.axes[7], segments[1, :, 2])
    assert rows.radii[7] == radii[1]
    part = joined(rows, rows).between(1.0, 2.0)
    assert len(part.way) == 12
    assert len(part.every(5).radii) == 3
    assert rows.between(9.0, 10.0).gap(PlacedBox("box", (0, 0, 0), (0, 0, 0), (1, 1, 1)).row()) == np.inf


def test_a_hand_in_the_chest_and_hands_in_each_other_are_seen() -> None:
    check = stock()[1].check
    hanging = np.zeros(LOCAL)
    hanging[[4, 8]] = 0.15
    hugged, folded = hanging.copy(), hanging.copy()
    hugged[3:7] = [0.5, -0.7, 1.2, 2.4]
    folded[[3, 7]], folded[[5, 9]], folded[[6, 10]], folded[[4, 8]] = 0.5, 1.0, 1.57, -0.2
    standing = np.zeros((3, 7))
    assert check.clear(standing, np.stack([hanging, hugged, folded])).tolist() == [True, False, False]
