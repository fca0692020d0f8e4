"""A scene for who takes no steps as high as others do: what is higher is no ground, but in the way."""

from dataclasses import dataclass, fields
from functools import cached_property

from elbowroom.world.ground.ground import PLAIN, Ground
from elbowroom.world.scene import Scene


@dataclass(frozen=True, eq=False)
class SteppedScene(Scene):
    """The same scene on ground of its own."""

    own_ground: Ground = PLAIN  # that of the scene, reached by lower steps

    @cached_property
    def ground(self) -> Ground:
        """What feet stand on."""
        return self.own_ground


def stepped(scene: Scene, highest: float) -> Scene:
    """A scene for who takes no step higher than so many metres; the scene itself where all steps are so low."""
    ground = scene.ground
    if ground.plain or highest >= ground.step:
        return scene
    same = {each.name: getattr(scene, each.name) for each in fields(Scene)}
    return SteppedScene(**same, own_ground=ground._replace(step=highest))
