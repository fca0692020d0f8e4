"""Capsules hold the surface, not its vertices: judged on points spread by chance over the area of posed skins."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from avatar_builder import Recipe, build
from elbowroom.body.dof import DofGroup, group_of_bone
from elbowroom.body.fitting.coverage import WANTED
from elbowroom.body.fitting.slim_capsule import distances
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes, load_with_surface
from elbowroom.body.loading.inspection import facts_of, inspect_avatar
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.pose.hands import relaxed_rotations
from elbowroom.body.stock import stock_avatar_path
from elbowroom.errors import InputError
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.experiment.judge.skin import Skin, skin_of
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from odd_bodies import Body, box_body, ring_body
from sampled import sampled
from shared_data import SHARED, needs_shared

Floats = NDArray[np.float64]

_POINTS = 4000
_FILES = (
    sorted(p for p in (SHARED / "avatars").rglob("*") if p.suffix in (".vrm", ".glb", ".x3d", ".wrl")) if SHARED else []
)


def outside(humanoid: Humanoid) -> Floats:
    """How far points of the surface are outside the capsules, in T-pose and walking: (P, S) metres."""
    skin, note = skin_of(humanoid)
    assert skin is not None, note
    return np.concatenate([_outside(humanoid, skin, posed) for posed in (_t_pose(humanoid), _walking(humanoid))])


def _t_pose(humanoid: Humanoid) -> Posed:
    relaxed = relaxed_rotations(humanoid.skeleton)[None]
    return Poser(humanoid).world(relaxed, humanoid.skeleton.positions[:1], np.zeros((1, 3)))


def _walking(humanoid: Humanoid) -> Posed:
    roots = np.zeros((8, 7))
    roots[:, 3], roots[:, 6] = 1.1, np.arange(8) / 8
    uppers = natural_walk()(RootPath(0.0, 1.0, roots))
    poser = Poser(humanoid)
    return poser.world(*poser.local(np.concatenate([roots[:, :3], uppers], axis=1), roots), roots[:, :3])


def _outside(humanoid: Humanoid, skin: Skin, posed: Posed) -> Floats:
    every = np.zeros((len(posed.positions), len(skin.joints), 3))
    used = np.unique(skin.triangles)
    every[:, used] = skin.vertices(posed, used)
    corners = every[:, skin.triangles]
    sides = corners[0, :, 1:] - corners[0, :, :1]
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    rng = np.random.default_rng(3)
    which, shares = rng.choice(len(areas), _POINTS, p=areas / areas.sum()), rng.dirichlet([1, 1, 1], _POINTS)
    return _gaps(humanoid, np.einsum("nsci,sc->nsi", corners[:, which], shares), posed)


def _gaps(humanoid: Humanoid, points: Floats, posed: Posed) -> Floats:
    """How far points (P, S, 3) of some poses are outside the capsules (P, S), metres."""
    capsules, gaps = humanoid.capsules, np.full(points.shape[:2], np.inf)
    for pose, (places, turns) in enumerate(zip(posed.positions, posed.rotations, strict=True)):
        for i, joint in enumerate(capsules.joints):
            start, end = (turns[joint] @ way[i] + places[joint] for way in (capsules.starts, capsules.ends))
            gaps[pose] = np.minimum(gaps[pose], distances(points[pose], start, end) - capsules.radii[i])
    return gaps


def tips_outside(humanoid: Humanoid) -> tuple[Floats, NDArray[np.bool_]]:
    """How far vertices of the surface are outside the capsules in T-pose (V,), and which of them legs carry."""
    skin, note = skin_of(humanoid)
    assert skin is not None, note
    used, posed = np.unique(skin.triangles), _t_pose(humanoid)
    gaps = _gaps(humanoid, skin.vertices(posed, used), posed)[0]
    legs = [group_of_bone(bone) is DofGroup.ROOT for bone in humanoid.skeleton.names]
    return gaps, np.array(legs)[skin.joints[used, 0]]


def assert_held(humanoid: Humanoid) -> None:
    gaps = outside(humanoid)
    assert np.mean(gaps <= 0.01, axis=1).min() >= 0.995
    assert gaps.max() < 0.04
    assert len(humanoid.capsules.names) <= 24


def assert_tips_held(humanoid: Humanoid) -> None:
    """No vertex stands farther out than motions keep away: 5 mm, legs 10."""
    gaps, legs = tips_outside(humanoid)
    assert gaps[~legs].max() < 0.0055
    assert gaps[legs].max() < 0.0105


@pytest.mark.parametrize(
    ("body", "worst"),
    [(ring_body(), 0.02), (ring_body(head=0.24), 0.02), (box_body(), 0.015), (box_body(head=0.42), 0.015)],
    ids=["low-poly", "low-poly with a big head", "boxes", "boxes with a big head"],
)
def test_bodies_of_few_triangles_are_held(body: Body, worst: float) -> None:
    humanoid = load_humanoid_bytes(build(Recipe(vrm="1", body=body)), "odd.vrm")
    assert humanoid.meta.has_body
    assert_held(humanoid)
    assert outside(humanoid).max() < worst
    assert_tips_held(humanoid)


def test_the_belly_of_a_low_poly_figure_is_as_wide_as_its_triangles() -> None:
    humanoid = load_humanoid_bytes(build(Recipe(vrm="1", body=ring_body())), "odd.vrm")
    capsules = humanoid.capsules
    belly = [i for i, name in enumerate(capsules.names) if name.startswith(("abdomen", "torso"))]
    ends = np.maximum(capsules.starts[belly, 0], capsules.ends[belly, 0]) + capsules.radii[belly]
    assert ends.max() > 0.16


def test_the_stock_avatar_is_held() -> None:
    assert_held(load_with_surface(stock_avatar_path())[0])


@needs_shared
@pytest.mark.parametrize(
    "path",
    [*sampled(_FILES[::3], len(_FILES)), *sampled(sorted({*_FILES} - {*_FILES[::3]}), 0)],
    ids=lambda path: path.name,
)
def test_real_avatars_are_held(path: Path) -> None:
    try:
        humanoid, surface = load_with_surface(path)
    except InputError:
        pytest.skip("this one is refused")
    if not humanoid.meta.has_body:
        pytest.skip("it has no mesh that is its body")
    assert_held(humanoid)
    assert_tips_held(humanoid)
    found = facts_of(humanoid, surface).coverage
    assert found is not None
    assert found.share >= WANTED
    assert min(found.parts.values()) > 0.98


def test_what_is_not_held_is_told_with_its_worst_place(tmp_path: Path) -> None:
    path = tmp_path / "boxes.vrm"
    path.write_bytes(build(Recipe(vrm="1", body=box_body())))
    humanoid, surface = load_with_surface(path)
    radii = humanoid.capsules.radii.copy()
    radii[humanoid.capsules.names.index("head")] -= 0.05
    facts = facts_of(replace(humanoid, capsules=replace(humanoid.capsules, radii=radii)), surface)
    (warning,) = facts.warnings
    assert "at the head" in warning
    assert facts.coverage is not None
    assert 0.04 < facts.coverage.worst < 0.07
    assert f"{100 * facts.coverage.worst:.1f} cm" in warning


def test_a_fitted_body_has_no_warning(tmp_path: Path) -> None:
    path = tmp_path / "boxes.vrm"
    path.write_bytes(build(Recipe(vrm="1", body=box_body())))
    facts, humanoid = inspect_avatar(path, LoadSettings())
    assert facts.warnings == ()
    assert humanoid.meta.has_body
