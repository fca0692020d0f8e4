"""The planners of one avatar in one scene, with what they remember: made when they are first needed, once."""

from functools import cached_property
from threading import Lock

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import MotionSet
from elbowroom.planning.motion import MotionPlanner
from elbowroom.planning.paper.local_planner import LocalPlanner
from elbowroom.planning.planner import Planner, make_planner
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.world.scene import Scene


class Planners:
    """A root planner and an upper-body planner; used by one thread at a time, which holds `lock` meanwhile."""

    def __init__(self, name: str, humanoid: Humanoid, scene: Scene, motions: MotionSet) -> None:
        self._made_of = name, humanoid, scene, motions
        self.lock = Lock()

    @cached_property
    def root(self) -> RootPlanner:
        """Plans root paths."""
        _, humanoid, scene, _ = self._made_of
        above = self.upper.trunk if isinstance(self.upper, LocalPlanner) else None
        return RootPlanner(humanoid, scene, above=above)

    @cached_property
    def upper(self) -> Planner:
        """Plans the upper body, some of them the root too."""
        return make_planner(*self._made_of)

    @cached_property
    def motion(self) -> MotionPlanner | None:
        """The planner of the upper body, if it plans the root too."""
        return self.upper if isinstance(self.upper, MotionPlanner) else None

    def make(self) -> None:
        """Make both now, which takes a while, unless that is done."""
        with self.lock:
            _ = self.root, self.upper

    def forget(self) -> None:
        """Forget all that was planned; the lock is held."""
        self.root.reset()
        self.upper.reset()
