"""The stock avatar's capsules lie beside it, fitted beforehand, and serve for that very file alone."""

import json
from pathlib import Path

import numpy as np
import pytest
from hatchling.builders.wheel import WheelBuilder

from elbowroom.body.capsules import Capsules
from elbowroom.body.dof import DofGroup, group_of_bone
from elbowroom.body.fitting.coverage import coverage
from elbowroom.body.fitting.fit import Fit, fit_capsules
from elbowroom.body.fitting.flexing import PosedPoints, poses_of
from elbowroom.body.fitting.slim_capsule import Slim
from elbowroom.body.fitting.stock_fit import fit_document, fit_of, stock_fit
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading import avatar_file as loading
from elbowroom.body.loading.avatar_file import load_humanoid_bytes, load_with_surface
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.stock import stock_avatar_path, stock_fit_path
from sampled import sampled

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def fits(monkeypatch: pytest.MonkeyPatch) -> list[Fit]:
    """The fits that loading makes."""
    made: list[Fit] = []

    def fitted(*args: object) -> Fit:
        made.append(fit_capsules(*args))  # type: ignore[arg-type]
        return made[-1]

    monkeypatch.setattr(loading, "fit_capsules", fitted)
    return made


def _assert_alike(one: Capsules, other: Capsules, scale: float = 1.0) -> None:
    assert (one.names, one.groups) == (other.names, other.groups)
    assert np.array_equal(one.joints, other.joints)
    for name in ("starts", "ends", "radii"):
        ours, theirs = getattr(one, name), getattr(other, name)
        assert (ours.dtype, ours.shape) == (theirs.dtype, theirs.shape)
        np.testing.assert_allclose(ours, scale * theirs, rtol=0.0, atol=1e-6)


def test_what_is_stored_holds_the_surface() -> None:
    humanoid, surface = load_with_surface(stock_avatar_path())
    stored = stock_fit(stock_avatar_path().read_bytes(), humanoid.skeleton)
    assert stored is not None, "stale: run tools/make_stock_avatar"
    _assert_alike(humanoid.capsules, stored.capsules)
    found = coverage(humanoid.skeleton, stored.capsules, surface.samples)
    assert found is not None
    assert found.share >= 0.995
    assert found.worst < 0.03  # of the pelvis in a deep crouch


@pytest.mark.parametrize("fitted_anew", sampled([False, True]))
def test_hands_are_held_as_closely_as_they_pass_things(fitted_anew: bool) -> None:
    """Motions keep 5 mm from obstacles: a knuckle that stands farther out than that may be seen in one."""
    humanoid, surface = load_with_surface(stock_avatar_path())
    skeleton = humanoid.skeleton
    capsules = fit_capsules(skeleton, surface).capsules if fitted_anew else humanoid.capsules
    for bone in ("leftHand", "rightHand"):
        joint = skeleton.index(bone)
        points = surface.samples.positions[surface.samples.joints == joint] - skeleton.positions[joint]
        assert len(points) > 200
        rows = np.flatnonzero(capsules.joints == joint)
        hand = [Slim(capsules.starts[i], capsules.ends[i], float(capsules.radii[i])) for i in rows]
        assert np.min([capsule.outside(points) for capsule in hand], axis=0).max() < 0.005


@pytest.mark.parametrize("fitted_anew", sampled([False, True]))
def test_no_vertex_of_the_head_stands_out(fitted_anew: bool) -> None:
    """It is shown a little lower or higher than planned, and passes under things by what is left."""
    humanoid, surface = load_with_surface(stock_avatar_path())
    skeleton = humanoid.skeleton
    capsules = fit_capsules(skeleton, surface).capsules if fitted_anew else humanoid.capsules
    points = surface.vertices.positions[surface.vertices.joints == skeleton.index("head")]
    assert len(points) > 200
    rest = skeleton.positions[capsules.joints]
    whole = zip(capsules.starts + rest, capsules.ends + rest, capsules.radii.tolist(), strict=True)
    assert np.min([Slim(start, end, radius).outside(points) for start, end, radius in whole], axis=0).max() < 1e-6


@pytest.mark.parametrize(("fitted_anew", "most"), [(False, 0.007), (True, 0.0011)])
def test_no_vertex_of_the_legs_stands_out_in_a_stride(fitted_anew: bool, most: float) -> None:
    """In narrow places legs keep nothing: neither a kneecap nor the edge of a sole may be out of the capsules.

    Hips have no such edges, and hold as much as the trunk does. The stored capsules were fitted to ankles that do not
    bend, so heels stand out of them as a foot rolls; feet that hold their heels so do not get through the doorway.
    """
    humanoid, surface = load_with_surface(stock_avatar_path())
    skeleton, poses = humanoid.skeleton, poses_of(humanoid.skeleton)
    capsules = fit_capsules(skeleton, surface).capsules if fitted_anew else humanoid.capsules
    legs = np.array([group_of_bone(bone) is DofGroup.ROOT for bone in skeleton.names])
    mine = legs[surface.vertices.joints]
    assert np.count_nonzero(mine) > 3000
    places = surface.posed[:, mine]
    points = PosedPoints(places.reshape(-1, 3), np.repeat(np.arange(len(places)), places.shape[1]))
    rest = skeleton.positions[capsules.joints]
    rows = zip(capsules.joints, capsules.starts + rest, capsules.ends + rest, capsules.radii.tolist(), strict=True)
    gaps = [poses.outside(Slim(start, end, radius), int(joint), points) for joint, start, end, radius in rows]
    outside = np.min(gaps, axis=0).reshape(places.shape[:2])
    hips = surface.vertices.joints[mine] == skeleton.index("hips")
    assert outside[:, ~hips].max() < most
    assert outside[:, hips].max() < 0.0051


def test_nothing_of_a_fit_is_lost_on_its_way_through_the_file() -> None:
    humanoid, surface = load_with_surface(stock_avatar_path())
    fit = fit_capsules(humanoid.skeleton, surface)._replace(bare=("neck", "head"))
    again = fit_of(json.loads(json.dumps(fit_document(b"", humanoid.skeleton, fit))), humanoid.skeleton)
    assert again.bare == fit.bare
    for name in ("joints", "starts", "ends", "radii"):
        assert getattr(again.capsules, name).tobytes() == getattr(fit.capsules, name).tobytes()
    assert (again.capsules.names, again.capsules.groups) == (fit.capsules.names, fit.capsules.groups)


def test_the_stock_avatar_is_not_fitted_anew(fits: list[Fit]) -> None:
    default = Humanoid.default()
    _assert_alike(load_humanoid_bytes(stock_avatar_path().read_bytes(), "mine.vrm").capsules, default.capsules)
    taller = Humanoid.load(stock_avatar_path(), LoadSettings(height=1.9))
    scale = taller.skeleton.height / default.skeleton.height
    assert scale > 1.05
    _assert_alike(taller.capsules, default.capsules, scale)
    assert not fits


@pytest.mark.parametrize("settings", sampled([LoadSettings(include_hair=True), LoadSettings(bones={"leftToes": None})]))
def test_with_other_settings_it_is_fitted(settings: LoadSettings, fits: list[Fit]) -> None:
    humanoid = Humanoid.load(stock_avatar_path(), settings)
    assert humanoid.capsules is fits[0].capsules


@pytest.mark.long
def test_bones_that_are_told_beside_it_count(tmp_path: Path, fits: list[Fit]) -> None:
    copy = tmp_path / "stock.vrm"
    copy.write_bytes(stock_avatar_path().read_bytes())
    copy.with_name("stock.vrm.bones.json").write_text('{"leftToes": null}')
    assert Humanoid.load(copy).capsules is fits[0].capsules


@pytest.mark.long
def test_a_changed_avatar_is_fitted(fits: list[Fit]) -> None:
    """By a bit; the file is as long as it was."""
    data = bytearray(stock_avatar_path().read_bytes())
    data[-4] ^= 1
    humanoid = load_humanoid_bytes(bytes(data), "stock.vrm")
    assert humanoid.capsules is fits[0].capsules


def test_it_is_for_files_alone() -> None:
    assert stock_fit(None, Humanoid.default().skeleton) is None


def test_the_wheel_holds_it() -> None:
    files = [Path(file.path) for file in WheelBuilder(str(ROOT)).recurse_included_files()]
    assert {stock_fit_path().name, stock_avatar_path().name} <= {file.name for file in files}
