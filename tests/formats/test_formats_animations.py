"""Key frames of glTF sampled as the specification says."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation, Slerp

from animation_builder import animated_glb
from elbowroom.errors import InputError
from elbowroom.formats.animations import KeyedTrack, read_animations, sample, take_of
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes

TIMES = np.array([0.5, 0.7, 1.4, 2.0])
AT = np.linspace(0.0, 2.5, 41)


def rotations(count: int) -> np.ndarray:
    turns: np.ndarray = Rotation.random(count, rng=np.random.default_rng(4)).as_quat()
    return turns


def test_linear_rotations_are_slerp_and_rest_at_the_ends() -> None:
    turns = rotations(4)
    found = sample(KeyedTrack(0, "rotation", "LINEAR", TIMES, turns), AT)
    wanted = Slerp(TIMES, Rotation.from_quat(turns))(np.clip(AT, TIMES[0], TIMES[-1]))
    assert (Rotation.from_quat(found).inv() * wanted).magnitude().max() < 1e-9


def test_linear_translations_are_straight() -> None:
    places = np.random.default_rng(1).standard_normal((4, 3))
    found = sample(KeyedTrack(0, "translation", "LINEAR", TIMES, places), AT)
    wanted = np.stack([np.interp(AT, TIMES, column) for column in places.T], axis=1)
    np.testing.assert_allclose(found, wanted, atol=1e-12)


def test_steps_hold_until_the_next_key() -> None:
    places = np.arange(12.0).reshape(4, 3)
    found = sample(KeyedTrack(0, "translation", "STEP", TIMES, places), np.array([0.0, 0.69, 0.7, 1.39, 2.0, 9.0]))
    np.testing.assert_array_equal(found[:, 0], [0, 0, 3, 3, 9, 9])


def test_cubic_splines_have_tangents_per_second() -> None:
    values = np.random.default_rng(2).standard_normal((4, 3, 3))
    inner = AT[(TIMES[0] <= AT) & (TIMES[-1] >= AT)]
    found = sample(KeyedTrack(0, "translation", "CUBICSPLINE", TIMES, values), inner)
    for k in range(3):
        here = (inner >= TIMES[k]) & (inner <= TIMES[k + 1])
        ends = values[k, 2], values[k + 1, 0]
        wanted = CubicHermiteSpline(TIMES[k : k + 2], values[k : k + 2, 1], np.stack(ends))(inner[here])
        np.testing.assert_allclose(found[here], wanted, atol=1e-9)


def test_a_single_key_is_a_pose() -> None:
    for mode, values in (("LINEAR", np.ones((1, 3))), ("CUBICSPLINE", np.ones((1, 3, 3)))):
        found = sample(KeyedTrack(0, "translation", mode, np.array([1.0]), values), AT)
        np.testing.assert_array_equal(found, np.ones((len(AT), 3)))


@pytest.mark.parametrize("mode", ["LINEAR", "CUBICSPLINE"])
def test_a_baked_animation_is_read_at_its_own_rate(mode: str) -> None:
    gltf = parse_gltf(animated_glb(mode=mode, frames=9), "a.glb")
    tree = read_nodes(gltf)
    (animation,) = read_animations(gltf, len(tree))
    take = take_of(animation, tree, "a.glb")
    assert (len(take), take.fps) == (9, 30.0)
    assert take.duration == pytest.approx(8 / 30)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (b'"node":3,', b'"node":999,', "node"),
        (b'"CUBICSPLINE"', b'"CUBICSPLINF"', "interpolation"),
        (b'"CUBICSPLINE"', b'"LINEAR"     ', "1 each"),
        (b'"sampler":3', b'"sampler":9999', "sampler"),
        (b'"output":4', b'"output":0', "type"),
    ],
)
def test_wrong_animations_are_refused(old: bytes, new: bytes, said: str) -> None:
    glb = animated_glb(mode="CUBICSPLINE")
    assert old in glb
    broken = glb.replace(old, new, 1)
    size = int.from_bytes(glb[12:16], "little") + len(new) - len(old)
    broken = broken[:8] + len(broken).to_bytes(4, "little") + size.to_bytes(4, "little") + broken[16:]
    gltf = parse_gltf(broken, "a.glb")
    with pytest.raises(InputError, match=said):
        read_animations(gltf, len(read_nodes(gltf)))
