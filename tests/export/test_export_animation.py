"""An animation shows what was recorded, frame by frame and between frames, in every layout."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.poses import Poser
from elbowroom.export.animation import Animation
from elbowroom.export.formats import Layout, Rest, RootMotion
from elbowroom.export.layout import take_of
from elbowroom.export.shown import ShownFrames
from elbowroom.geometry import quaternion
from made_recording import Made, made_recording

Floats = NDArray[np.float64]
AVATAR = Humanoid.default()


@pytest.fixture(scope="module")
def even(tmp_path_factory: pytest.TempPathFactory) -> Made:
    return made_recording(tmp_path_factory.mktemp("even") / "run.elbow", AVATAR)


@pytest.fixture(scope="module")
def odd(tmp_path_factory: pytest.TempPathFactory) -> Made:
    return made_recording(tmp_path_factory.mktemp("odd") / "run.elbow", AVATAR, even=False)


def judged(made: Made, moments: Moments) -> Floats:
    """Joints (N, J, 3) in the world as the judge poses them, who shares no kinematics with us."""
    return Poser(AVATAR).at(ShownMotion.of(made.recording), moments).positions


def test_recorded_frames_are_exported_as_they_are(even: Made) -> None:
    animation = Animation.of(even.recording, AVATAR)
    frames = np.arange(len(even.times))
    assert len(animation) == len(frames)
    theirs = judged(even, Moments(frames, frames, np.zeros(len(frames)), even.times))
    np.testing.assert_allclose(animation.joints_in_world(), theirs, atol=1e-9)


@pytest.mark.parametrize("fps", [24.0, 30.0, 100.0])
def test_between_frames_it_goes_as_on_the_page(odd: Made, fps: float) -> None:
    animation = Animation.of(odd.recording, AVATAR, fps)
    moments = odd.times[0] + np.arange(len(animation)) / fps
    before = np.searchsorted(odd.times, moments, side="right") - 1
    after = np.minimum(before + 1, len(odd.times) - 1)
    share = (moments - odd.times[before]) / np.maximum(odd.times[after] - odd.times[before], 1e-12)
    share[after == odd.restart] = 0.0
    theirs = judged(odd, Moments(before, after, share, moments))
    np.testing.assert_allclose(animation.joints_in_world(), theirs, atol=2e-5)
    assert moments[-1] <= odd.times[-1] + 1e-9 < moments[-1] + 1.0 / fps


def test_over_a_restart_nothing_is_mixed(odd: Made) -> None:
    before, after, share = ShownFrames.of(odd.recording).at_rate(240.0)
    assert (after == odd.restart).any()
    assert not share[after == odd.restart].any()
    assert share[(after != odd.restart) & (after > before)].any()


@pytest.mark.parametrize(("root", "rest", "up"), list(product(RootMotion, Rest, "yz")))
def test_every_layout_puts_the_joints_in_the_same_places(even: Made, root: RootMotion, rest: Rest, up: str) -> None:
    animation = Animation.of(even.recording, AVATAR)
    layout = Layout(root, rest, 0.01, up)
    take = take_of(animation, layout)
    first = 1 if root is RootMotion.ROOT else 0
    assert take.tree.names[first:] == AVATAR.skeleton.names
    found = take.world(np.arange(first, len(take.tree)))[1] * layout.unit
    if up == "z":
        found = np.stack([found[..., 0], found[..., 2], -found[..., 1]], axis=-1)
    wanted = animation.joints_in_world()
    if root is RootMotion.NONE:
        back = quaternion.conjugate(animation.turns())
        wanted = quaternion.rotate(back[:, None], wanted - animation.places[:, None])
    np.testing.assert_allclose(found, wanted, atol=1e-9)
    arm = take.tree.translations[first + AVATAR.skeleton.index("leftLowerArm")][2 if up == "z" else 1]
    assert (arm < -0.1 / layout.unit) == (rest is Rest.A)


def test_a_rate_out_of_range_and_too_many_frames_are_refused(even: Made, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="fps: 0"):
        Animation.of(even.recording, AVATAR, 0.0)
    with pytest.raises(InputError, match="fps: nan"):
        Animation.of(even.recording, AVATAR, float("nan"))
    empty = made_recording(tmp_path / "empty.elbow", AVATAR, 0)
    with pytest.raises(InputError, match="holds no frames"):
        Animation.of(empty.recording, AVATAR)
