"""A recorded clip played on an avatar: it moves as the recorded body did, or as planning would keep it."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.clips.performance import PlayedPose, perform
from elbowroom.control.frame import Frame, Phase
from elbowroom.control.key_frame_queue import KeyFrames
from elbowroom.control.shown.body_check import BodyCheck, configuration
from elbowroom.control.things.loose import Thing
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.server.sessions.walk import WalkSettings
from elbowroom.server.stores.avatar_store import StoredAvatar
from elbowroom.server.stores.clip_store import StoredClip
from elbowroom.server.wire.pose import NodePose
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_NO_KEYS = KeyFrames(np.empty(0), np.empty((0, ROOT_STATE)), np.empty((0, LOCAL)))


class ClipWalk:
    """Plays a clip over and over from the start of a scene; it obeys no command, and touches what it touches.

    Clearance is that of the body as planning keeps it.
    """

    plans = plans_failed = late_plans = stuck_since_start = 0
    finished = False

    def __init__(
        self, avatar: StoredAvatar, scene: Scene, settings: WalkSettings, stored: StoredClip, *, as_planned: bool
    ) -> None:
        """Put the clip on the avatar: takes a while. Raises `InputError` if the clip cannot be read."""
        self.avatar, self.scene, self.settings, self.stored = avatar, scene, settings, stored
        self.as_planned = as_planned  # show only what the planning degrees of freedom keep
        self.crossed = self.stuck_times = 0
        self.rounds = 0  # times that it has jumped back to its beginning
        self._performance = perform(stored.clip, avatar.humanoid.skeleton, scene.start)
        self._check = BodyCheck(avatar.humanoid, scene)
        self.reset()

    @property
    def place(self) -> RootState:
        """Where a walk that follows begins: at the scene's start."""
        return self.scene.start

    @property
    def surroundings(self) -> Scene:
        """The scene: nothing is pushed in it."""
        return self.scene

    @property
    def things(self) -> Mapping[int, Thing]:
        """Nothing is pushed."""
        return {}

    def recording(self) -> bytes:
        """Raises `InputError`."""
        raise InputError("no walk is recorded: a recorded motion plays; walk first")

    def push(self, number: int, place: tuple[float, float] | None) -> None:
        """Raises `InputError`."""
        del number
        if place is not None:
            raise InputError("push: a recorded motion plays; walk first")

    def heeds(self, command: Command) -> bool:
        """No command waits for an answer."""
        del command
        return True

    def reset(self) -> None:
        """From the beginning."""
        self._time = 0.0
        self._show()

    def adjust(self, settings: WalkSettings) -> None:
        """Keep settings for the walk that follows."""
        self.settings = settings

    def step(self, command: Command, dt: float) -> None:
        """Go on by `dt` seconds, whatever the command."""
        del command
        self._time += dt
        if self._time >= self._performance.duration:
            self._time %= self._performance.duration
            self.rounds += not self._performance.seamless
        self._show()

    def node_pose(self) -> NodePose:
        """What the avatar's nodes get now."""
        if self.as_planned:
            return self.avatar.poser.node_pose(self.frame.q, self.frame.root)
        return self.avatar.poser.full_pose(self._moment.rotations, self._moment.hips)

    def _show(self) -> None:
        moment: PlayedPose = self._performance.at(self._time)
        clearance = self._check.clearance(self._check.standing(moment.root), moment.upper, self._time)
        self._moment = moment
        self.frame = Frame(
            time=self._time,
            q=configuration(moment.root, moment.upper),
            root=moment.root,
            phase=Phase.PLAY,
            clearance=clearance,
            stuck=False,
            touching=clearance < 0.0,
            fill=0,
            key_frames=_NO_KEYS,
            plan=None,
        )
