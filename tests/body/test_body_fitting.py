import numpy as np

from elbowroom.body.fitting.body_parts import BodyPoints, part_of_points
from elbowroom.body.fitting.coverage import coverage
from elbowroom.body.fitting.fit import fit_capsules
from elbowroom.body.fitting.flexing import poses_of
from elbowroom.body.fitting.proportions import proportional_capsules, proportional_skeleton
from elbowroom.body.fitting.surface import Surface

SKELETON = proportional_skeleton(1.7)


def _surface_of_capsules(rng: np.random.Generator, each: int) -> BodyPoints:
    """Points on capsules half as thick again as the average."""
    capsules = proportional_capsules(SKELETON)
    points, joints = [], []
    for joint, start, end, radius in zip(capsules.joints, capsules.starts, capsules.ends, capsules.radii, strict=True):
        where = rng.uniform(0.0, 1.0, (each, 1))
        outward = rng.normal(size=(each, 3))
        outward *= 1.5 * radius / np.linalg.norm(outward, axis=1, keepdims=True)
        points.append(SKELETON.positions[joint] + start + where * (end - start) + outward)
        joints.append(np.full(each, joint))
    return BodyPoints(np.concatenate(points), np.concatenate(joints))


def _rigid(points: BodyPoints) -> Surface:
    """A surface of points that each move with their one joint."""
    return Surface(poses_of(SKELETON).carried(points.joints, points.positions), points.joints, points)


def test_capsules_are_found_again_from_their_surface() -> None:
    points = _surface_of_capsules(np.random.default_rng(0), 300)
    capsules, bare, _ = fit_capsules(SKELETON, _rigid(points))
    average = proportional_capsules(SKELETON)
    assert bare == ()
    assert capsules.names == average.names
    found = coverage(SKELETON, capsules, points)
    assert found is not None
    assert found.share > 0.97
    thick = capsules.radii / average.radii
    assert np.all((thick > 1.1) & (thick < 1.75))


def test_parts_without_points_keep_average_proportions() -> None:
    head = SKELETON.index("head")
    ball = 0.1 * np.random.default_rng(1).normal(size=(200, 3)) + SKELETON.positions[head]
    points = BodyPoints(ball, np.full(200, head))
    capsules, bare, _ = fit_capsules(SKELETON, _rigid(points))
    average = proportional_capsules(SKELETON)
    assert set(bare) == set(average.names) - {"head", "shoulders"}
    others = [i for i, name in enumerate(average.names) if name != "head"]
    assert np.array_equal(capsules.radii[others], average.radii[others])


def test_points_belong_to_the_part_of_their_bone() -> None:
    average = proportional_capsules(SKELETON)
    bones = ["hips", "leftToes", "rightFoot", "jaw", "leftShoulder", "rightLowerArm", "head"]
    expected = ["pelvis", "leftFoot", "rightFoot", None, "chest", "rightForearm", "head"]
    for bone, name in zip(bones, expected, strict=True):
        if not SKELETON.has(bone):
            continue
        joint = SKELETON.index(bone)
        part = part_of_points(SKELETON, average, BodyPoints(SKELETON.positions[[joint]], np.array([joint])))[0]
        assert average.names[part] == name


def test_the_fit_repeats_exactly() -> None:
    points = _surface_of_capsules(np.random.default_rng(2), 60)
    once, again = (fit_capsules(SKELETON, _rigid(points))[0] for _ in range(2))
    assert np.array_equal(once.radii, again.radii)
    assert np.array_equal(once.ends, again.ends)
