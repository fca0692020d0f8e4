"""A frame's pose is the one that exports show, which other programs judge, and its rotations lead to its joints."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.export.animation import Animation
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene


def test_it_is_what_a_recording_of_it_shows(tmp_path: Path) -> None:
    avatar = Humanoid.default()
    controller, poses = Controller(avatar, Scene.load("c")), []
    with Recorder(tmp_path / "walk.elbow", controller) as recorder:
        for _ in range(90):
            frame = controller.step(Command(forward=1.0, turn=0.3), 1 / 60)
            recorder.append(frame, 1 / 60)
            poses.append(frame.pose(avatar))
    shown = Animation.of(Recording(tmp_path / "walk.elbow"), avatar).joints_in_world()
    np.testing.assert_allclose([pose.joints for pose in poses], shown, atol=1e-9)
    skeleton, pose = avatar.skeleton, poses[-1]
    worlds, places = [Rotation.from_quat(pose.rotations[0])], [pose.joints[0]]
    for joint, parent in enumerate(skeleton.parents.tolist()):
        if parent >= 0:
            bone = skeleton.positions[joint] - skeleton.positions[parent]
            places.append(places[parent] + worlds[parent].apply(bone))
            worlds.append(worlds[parent] * Rotation.from_quat(pose.rotations[joint]))
    np.testing.assert_allclose(places, pose.joints, atol=1e-9)
    np.testing.assert_array_equal(pose.joint("head"), pose.joints[pose.bones.index("head")])
    np.testing.assert_array_equal(pose.rotation("head"), pose.rotations[pose.bones.index("head")])
    with pytest.raises(KeyError, match="tail"):
        pose.joint("tail")
