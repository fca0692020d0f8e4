"""Feet of any shape roll over the ground: nothing of them gets into it, and what they stand on does not slip."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.fitting.body_mesh import BodyMesh
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.fitting.rolling import soles_of
from elbowroom.body.gait.cycle import gait_shape
from elbowroom.body.gait.footholds import beside
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import FOOT, ROOT_STATE
from elbowroom.body.skeleton import Skeleton
from elbowroom.body.soles import Soles

Floats = NDArray[np.float64]

PITCH = ROOT_STATE + 3  # of the left foot; the right one's is FOOT further on
PITCHES = np.linspace(-0.29, 1.05, 135)
BALL, HEEL, PITCH_DOWN, PITCH_UP, HANG, OWN = 6, 7, 11, 12, 13, 14  # columns of the legs


def without_toes(humanoid: Humanoid) -> Humanoid:
    skeleton = humanoid.skeleton
    kept = [i for i, name in enumerate(skeleton.names) if not name.endswith("Toes")]
    parents = np.array([-1 if p < 0 else kept.index(p) for p in skeleton.parents[kept]])
    fewer = Skeleton(tuple(skeleton.names[i] for i in kept), parents, skeleton.positions[kept])
    capsules = humanoid.capsules
    joints = np.array([kept.index(j) for j in capsules.joints])
    return replace(humanoid, skeleton=fewer, capsules=replace(capsules, joints=joints))


def mesh_of(skeleton: Skeleton, points: Floats, on_toes: Floats) -> BodyMesh:
    """The same points (P, 3) from both ankles over the ground, carried by foot and toes in these parts (P,)."""
    places, joints, weights = [], [], []
    for side in ("left", "right"):
        foot = skeleton.index(f"{side}Foot")
        toes = skeleton.index(f"{side}Toes") if skeleton.has(f"{side}Toes") else foot
        places.append(points + skeleton.positions[foot] * [1.0, 0.0, 1.0])
        order = np.where(on_toes > 0.5, 1, 0)[:, None]
        both = np.where(order == 1, [[toes, foot]], [[foot, toes]])
        joints.append(both)
        weights.append(np.where(order == 1, np.c_[on_toes, 1.0 - on_toes], np.c_[1.0 - on_toes, on_toes]))
    every = np.concatenate(places)
    corners = np.arange(len(every) // 3 * 3).reshape(-1, 3)
    return BodyMesh(
        corners,
        np.concatenate(joints),
        np.concatenate(weights),
        np.stack([every, every], axis=1),
        np.zeros(0, np.int64),
    )


def random_foot(seed: int, ball: float) -> tuple[Floats, Floats]:
    """A boot, box or paw of 60 points, and how far its front hangs on the toes."""
    random = np.random.default_rng(seed)
    points = random.uniform(
        [-0.04, 0.0, -random.uniform(0.02, 0.14)], [0.04, 0.07, random.uniform(0.12, 0.26)], (60, 3)
    )
    points[:8, 1] = 0.0
    points[:, 1] -= points[:, 1].min()
    blend = random.uniform(0.005, 0.05)
    return points, np.clip((points[:, 2] - ball) / blend + 0.5, 0.0, 1.0)


def pitched(humanoid: Humanoid, soles: Soles) -> tuple[Floats, Floats]:
    """Left ankles (F, 2) on the plane, how high and far ahead, where feet are pitched more and more; real pitches."""
    gait = gait_shape(humanoid.skeleton, soles)
    rows = np.repeat(beside(gait, np.zeros(ROOT_STATE))[None], len(PITCHES), axis=0)
    rows[:, PITCH] = rows[:, PITCH + FOOT] = PITCHES
    feet, _ = posed_feet(gait.legs, gait.scale, gait.half_leg, rows, np.full(len(rows), 0.3))
    return feet[:, 0, 1:3] - [0.0, rows[0, ROOT_STATE + 1]], feet[:, 0, 4]


def posed(humanoid: Humanoid, body: BodyMesh, ankles: Floats, pitches: Floats) -> Floats:
    """The left foot's points (F, P, 2), up and ahead, by turning them: toes are level where the heel is up."""
    skeleton = humanoid.skeleton
    foot = skeleton.index("leftFoot")
    toes = skeleton.index("leftToes") if skeleton.has("leftToes") else foot
    own = np.isin(body.joints[:, 0], [foot, toes])
    found = np.zeros((len(pitches), own.sum(), 2))
    for frame, (ankle, pitch) in enumerate(zip(ankles, pitches, strict=True)):
        for joint in {foot, toes}:
            by = min(pitch, 0.0) if joint == toes != foot else pitch
            at = (
                ankle
                if joint == foot
                else ankle + turned((skeleton.positions[toes] - skeleton.positions[foot])[1:], pitch)
            )
            moved = turned(body.places[own, 0, 1:] - skeleton.positions[joint, 1:], by) + at
            found[frame] += np.where(body.joints[own] == joint, body.weights[own], 0.0).sum(axis=1)[:, None] * moved
    return found


def turned(places: Floats, pitch: float) -> Floats:
    """Places (..., 2) up and ahead, with the toes down by a pitch."""
    up, ahead = places[..., 0], places[..., 1]
    return np.stack([up * np.cos(pitch) - ahead * np.sin(pitch), ahead * np.cos(pitch) + up * np.sin(pitch)], axis=-1)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("bare", [False, True])
def test_at_every_pitch_the_lowest_point_is_on_the_ground_and_something_stands_still(seed: int, bare: bool) -> None:
    humanoid = without_toes(proportional_humanoid()) if bare else proportional_humanoid()
    points, on_toes = random_foot(seed, 0.129)
    body = mesh_of(humanoid.skeleton, points, np.zeros(60) if bare else on_toes)
    ankles, pitches = pitched(humanoid, soles_of(humanoid.skeleton, humanoid.capsules, body))
    places = posed(humanoid, body, ankles, pitches)
    lowest = places[..., 0].min(axis=1)
    assert lowest.min() > -1e-3  # between two pitches that are told
    assert lowest[pitches >= 0.0].max() < 1e-3
    assert lowest.max() < 0.0085  # a heel that is short hovers a little
    steps = np.abs(np.diff(places[..., 1], axis=0))
    near = np.maximum(places[1:, :, 0], places[:-1, :, 0]) < np.maximum(lowest[1:], lowest[:-1])[:, None] + 0.005
    slips = np.where(near, steps, np.inf).min(axis=1)
    assert slips.sum() < 2.5e-3
    assert ankles[-1, 0] > ankles[100, 0] > 0.1


def test_an_average_foot_without_a_mesh_rolls_as_it_always_did() -> None:
    humanoid = proportional_humanoid()
    soles = soles_of(humanoid.skeleton, humanoid.capsules, None)
    own, average = gait_shape(humanoid.skeleton, soles).legs, gait_shape(humanoid.skeleton).legs
    assert own[:, [BALL, PITCH_DOWN]] == pytest.approx(average[:, [BALL, PITCH_DOWN]])
    assert np.abs(own[:, OWN:]).max() < 1.5e-3  # its heel is a little shorter
    assert not average[:, OWN:].any()


def test_a_foot_without_toes_rolls_over_its_tip_and_is_pitched_less() -> None:
    humanoid = without_toes(proportional_humanoid())
    box = np.array([[x, y, z] for x in (-0.05, 0.05) for y in (0.0, 0.05) for z in (-0.1, 0.3)])
    body = mesh_of(humanoid.skeleton, box, np.zeros(8))
    soles = soles_of(humanoid.skeleton, humanoid.capsules, body)
    assert soles.tips == pytest.approx([0.3, 0.3])
    assert soles.heels == pytest.approx([0.1, 0.1])
    legs = gait_shape(humanoid.skeleton, soles).legs
    assert legs[:, BALL] == pytest.approx([0.3, 0.3])
    assert legs[:, HEEL] == pytest.approx([0.1, 0.1])
    assert legs[:, PITCH_DOWN] == pytest.approx(0.18 * legs[:, 8:10].sum(axis=1) / 0.3)
    assert legs[:, PITCH_UP] == pytest.approx(0.092 * legs[:, 8:10].sum(axis=1) / 0.1)
    _, pitches = pitched(humanoid, soles)
    assert pitches[-1] == pytest.approx(legs[0, PITCH_DOWN] * PITCHES[-1])
    assert pitches[0] == pytest.approx(legs[0, PITCH_UP] * PITCHES[0])


def test_skis_are_no_feet() -> None:
    humanoid = proportional_humanoid()
    points, on_toes = random_foot(1, 0.129)
    body = mesh_of(humanoid.skeleton, points, on_toes)
    skis = mesh_of(
        humanoid.skeleton, np.concatenate([points, [[0.0, 0.0, 40.0], [0.0, 0.0, -1.1]]]), np.r_[on_toes, 0, 0]
    )
    for found, alone in zip(
        *(soles_of(humanoid.skeleton, humanoid.capsules, each) for each in (skis, body)), strict=True
    ):
        assert found == pytest.approx(alone)


def test_long_toes_hang_less() -> None:
    humanoid = proportional_humanoid()
    soles = soles_of(humanoid.skeleton, humanoid.capsules, None)
    long = soles._replace(tips=soles.tips + 0.15)
    own, longer = (gait_shape(humanoid.skeleton, each).legs for each in (soles, long))
    assert gait_shape(humanoid.skeleton).legs[:, HANG] == pytest.approx([1.0, 1.0])
    assert own[:, HANG].min() > 0.9
    assert longer[:, HANG] == pytest.approx(0.09 * own[:, 8:10].sum(axis=1) / (long.tips - own[:, BALL]))
    assert longer[:, HANG].max() < 0.4


def test_soles_grow_with_the_body() -> None:
    humanoid = proportional_humanoid()
    soles = soles_of(humanoid.skeleton, humanoid.capsules, None)
    twice = soles.scaled(2.0)
    for small, large in zip(soles, twice, strict=True):
        assert large == pytest.approx(2.0 * small)
