"""A scene for who takes other steps than most: what is higher is no ground, but in the way."""

from dataclasses import dataclass, fields
from functools import cached_property

from elbowroom.world.ground.ground import PLAIN, Ground
from elbowroom.world.ground.making import ground_of, over_floors
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene


@dataclass(frozen=True, eq=False)
class SteppedScene(Scene):
    """The same scene on ground of its own."""

    own_ground: Ground = PLAIN  # that of the scene, reached by lower steps, or by higher ones

    @cached_property
    def ground(self) -> Ground:
        """What feet stand on."""
        return self.own_ground


def stepped(scene: Scene, highest: float) -> Scene:
    """A scene for who takes no step higher than so many metres; the scene itself where all steps are so low."""
    ground = scene.ground
    if ground.plain or highest >= ground.step:
        return scene
    return _on(scene, ground._replace(step=highest))


def climbed(scene: Scene, highest: float) -> Scene:
    """A scene for who climbs over and onto what is up to so many metres high; on the same ground where nothing is."""
    floor = scene.place.floor if scene.place else None
    ground = ground_of(scene.obstacles, floor, highest)
    if ground.plain:
        return _on(scene, scene.ground)
    return _on(scene, ground, scene.obstacles if floor is None else over_floors(scene.obstacles))


def _on(scene: Scene, ground: Ground, obstacles: Obstacles | None = None) -> Scene:
    """The scene on other ground, and with other obstacles, if any are given."""
    same = {each.name: getattr(scene, each.name) for each in fields(Scene)}
    return SteppedScene(**same | {"obstacles": obstacles or scene.obstacles}, own_ground=ground)
