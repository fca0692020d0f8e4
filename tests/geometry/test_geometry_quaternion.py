"""Laws of the quaternion room, over random batches, with SciPy's rotations as the judge."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]


@pytest.fixture(params=[0, 1, 2])
def rotations(request: pytest.FixtureRequest) -> tuple[Floats, Floats]:
    a, b = Rotation.random(2 * 500, rng=np.random.default_rng(request.param)).as_quat().reshape(2, 500, 4)
    return a, b


def same_rotation(a: Floats, b: Floats) -> Floats:
    apart: Floats = 1.0 - np.abs(np.sum(a * b, axis=-1))
    return apart


def test_product_is_composition(rotations: tuple[Floats, Floats]) -> None:
    a, b = rotations
    ours = quaternion.multiply(a, b)
    assert np.max(same_rotation(ours, (Rotation.from_quat(a) * Rotation.from_quat(b)).as_quat())) < 1e-12


def test_inverse_undoes(rotations: tuple[Floats, Floats]) -> None:
    a, _ = rotations
    assert np.max(same_rotation(quaternion.multiply(a, quaternion.conjugate(a)), quaternion.IDENTITY)) < 1e-12


def test_rotate_and_matrix_agree_with_scipy(rotations: tuple[Floats, Floats]) -> None:
    a, _ = rotations
    v = np.random.default_rng(5).normal(size=(len(a), 3))
    np.testing.assert_allclose(quaternion.rotate(a, v), Rotation.from_quat(a).apply(v), atol=1e-12)
    np.testing.assert_allclose(quaternion.to_matrix(a), Rotation.from_quat(a).as_matrix(), atol=1e-12)


def test_matrix_round_trip(rotations: tuple[Floats, Floats]) -> None:
    a, _ = rotations
    assert np.max(same_rotation(quaternion.from_matrix(quaternion.to_matrix(a)), a)) < 1e-12


def test_half_turns_survive_the_matrix() -> None:
    half_turns = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0.6, 0.8, 0, 0]])
    assert np.max(same_rotation(quaternion.from_matrix(quaternion.to_matrix(half_turns)), half_turns)) < 1e-12


def test_rotation_vector_round_trip(rotations: tuple[Floats, Floats]) -> None:
    a, _ = rotations
    vector = quaternion.to_rotation_vector(a)
    np.testing.assert_allclose(vector, Rotation.from_quat(a).as_rotvec(), atol=1e-9)
    assert np.max(same_rotation(quaternion.from_rotation_vector(vector), a)) < 1e-12


def test_tiny_rotations_keep_their_size() -> None:
    tiny = np.array([[1e-9, 0, 0], [0, -3e-10, 0], [0, 0, 0]])
    np.testing.assert_allclose(
        quaternion.to_rotation_vector(quaternion.from_rotation_vector(tiny)), tiny, rtol=1e-9, atol=1e-24
    )


def test_about_axis() -> None:
    for axis in range(3):
        expected = Rotation.from_rotvec(np.eye(3)[axis] * 0.7).as_quat()
        assert same_rotation(quaternion.about_axis(axis, 0.7), expected) < 1e-12


def test_between_is_the_shortest_rotation(rotations: tuple[Floats, Floats]) -> None:
    rng = np.random.default_rng(9)
    a, b = rng.normal(size=(2, 500, 3))
    turn = quaternion.between(a, b)
    unit_a, unit_b = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (a, b))
    np.testing.assert_allclose(quaternion.rotate(turn, unit_a), unit_b, atol=1e-9)
    angle = np.linalg.norm(quaternion.to_rotation_vector(turn), axis=1)
    np.testing.assert_allclose(np.cos(angle), np.sum(unit_a * unit_b, axis=1), atol=1e-9)


def test_between_opposite_directions() -> None:
    for axis in np.eye(3):
        np.testing.assert_allclose(quaternion.rotate(quaternion.between(axis, -axis), axis), -axis, atol=1e-9)


def test_slerp_goes_the_short_way_at_constant_speed(rotations: tuple[Floats, Floats]) -> None:
    a, b = rotations
    total = np.linalg.norm(quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(a), b)), axis=1)
    part = quaternion.slerp(a, b, np.full(len(a), 0.25))
    done = np.linalg.norm(quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(a), part)), axis=1)
    np.testing.assert_allclose(done, 0.25 * total, atol=1e-9)
    assert np.all(total <= np.pi + 1e-9)
