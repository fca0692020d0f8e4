"""What a session is to show, by names of the library."""

from dataclasses import dataclass, replace

from elbowroom.server.clip_walk import ClipWalk
from elbowroom.server.schema.commands import Configure
from elbowroom.server.schema.progress import Loading
from elbowroom.server.sessions.walk import Walk, WalkSettings


@dataclass(frozen=True)
class Wanted:
    """What a session shows: names from the library."""

    scene: str
    avatar: str
    settings: WalkSettings
    clip: str = ""  # "": the avatar walks
    as_planned: bool = False

    @classmethod
    def of(cls, walk: Walk | ClipWalk) -> "Wanted":
        """What is shown now."""
        clip = (walk.stored.id, walk.as_planned) if isinstance(walk, ClipWalk) else ("", False)
        return cls(walk.scene.name, walk.avatar.id, walk.settings, *clip)

    def changed(self, message: Configure) -> "Wanted":
        """The same with what a client has chosen; a style comes at the speed that it likes, unless one is asked for."""
        before = self.settings if message.style is None else self.settings.in_style(message.style)
        chosen = {name: getattr(message, name) for name in ("planner", "queue_size", "assist", "walk_speed")}
        settings = replace(before, **{name: value for name, value in chosen.items() if value is not None})
        return Wanted(
            scene=message.scene or self.scene,
            avatar=message.avatar or self.avatar,
            settings=settings,
            clip=self.clip if message.clip is None else message.clip,
            as_planned=self.as_planned if message.clip_as_planned is None else message.clip_as_planned,
        )

    def differs(self, now: "Wanted") -> bool:
        """Whether something new must be made to show this after `now`."""
        mine, old = self.settings, now.settings
        planner = (mine.planner, mine.queue_size, mine.style) != (old.planner, old.queue_size, old.style)
        return replace(self, settings=old) != now or (planner and not self.clip)

    def loading(self, now: "Wanted") -> Loading:
        """What a client is told while this is made."""
        if self.avatar != now.avatar:
            return Loading("avatar", self.avatar, True)
        if self.scene != now.scene:
            return Loading("scene", self.scene, True)
        if self.clip:
            return Loading("clip", self.clip, True)
        return Loading("planner", self.settings.planner, True)
