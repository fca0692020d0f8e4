"""What stands about one avatar, and all that stands its feet, checks its poses, plans its motion and finds its ways."""

from functools import cached_property

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import MotionSet
from elbowroom.control.feet.stepping import Stepping
from elbowroom.control.plans.planners import Planners
from elbowroom.control.plans.wayfinder import Wayfinder
from elbowroom.control.settings import ControlSettings
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.control.shown.own_body_check import own_body_check
from elbowroom.planning.names import EXACT
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.world.scene import Scene


class PlanningScene:
    """A scene as one avatar's controller uses it; where something else stands, there is a new one."""

    def __init__(self, humanoid: Humanoid, scene: Scene, settings: ControlSettings, motions: MotionSet) -> None:
        """`motions` are as they fit the humanoid. Planners and navigator are made when they are first needed."""
        self._humanoid, self.scene = humanoid, scene
        self.free_map = scene.free_map
        self.check = BodyCheck(humanoid, scene)
        # of other planners what is shown would be held for ever: they do not keep out of their own body
        self.own_body = own_body_check(humanoid, motions) if settings.planner == EXACT else None
        self.feet = Stepping(humanoid, motions, self.check.soles)
        self.planners = Planners(settings.planner, humanoid, scene, motions)
        self.wayfinder = Wayfinder(settings, self.check, motions, self.planners)

    @cached_property
    def navigator(self) -> Navigator:
        """Finds ways here."""
        return Navigator(self._humanoid, self.scene)

    def forget(self) -> None:
        """Forget all that was planned; a plan that is still in the making is for nobody."""
        self.wayfinder = self.wayfinder.afresh()
