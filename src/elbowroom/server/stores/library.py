"""What the sessions of one server share: the scenes, the avatars, and the choices that a session begins with."""

from collections.abc import Callable, Hashable
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING

from elbowroom.body.loading.settings import LoadSettings
from elbowroom.clips.motion_set import MotionSet
from elbowroom.clips.style import STYLES
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.names import NAMED, PREFIX, parse_name
from elbowroom.experiment.gauntlet.scenes import load_scene, random_names
from elbowroom.experiment.parallel import usable_cores
from elbowroom.planning.names import planner_names
from elbowroom.server.schema.bounds import QUEUE_SIZES, WALK_SPEEDS
from elbowroom.server.schema.menus import Catalog, SceneChoice, StyleChoice
from elbowroom.server.sessions.meter import Meter
from elbowroom.server.sessions.walk import WalkSettings
from elbowroom.server.stores.avatar_store import STOCK, AvatarStore
from elbowroom.server.stores.clip_store import ClipStore
from elbowroom.server.stores.courses import Courses
from elbowroom.server.stores.place_files import PlaceFiles
from elbowroom.server.stores.sent_scenes import SentScenes
from elbowroom.server.stores.shelf import OwnShelf, Shelf
from elbowroom.server.vmc.stream import VmcStream
from elbowroom.world.scene import Scene

if TYPE_CHECKING:
    from elbowroom.server.sessions.wanted import Wanted


def planning_threads(begin: Callable[[], object] | None = None) -> Executor:
    """One more than cores: in more, plans that come at once would all come late. Each calls `begin` first."""
    return ThreadPoolExecutor(usable_cores() + 1, "planning", begin)


@dataclass(frozen=True, eq=False)
class Library:
    """Scenes and avatars by name."""

    avatars: AvatarStore
    scenes: dict[str, Scene]
    scene: str  # the names that a session begins with
    avatar: str
    walk: WalkSettings
    clips: ClipStore = field(default_factory=ClipStore)
    clip: str = ""  # that a session begins with; "": it walks
    courses: Courses = field(default_factory=Courses)
    motions: MotionSet = field(default_factory=MotionSet)  # what avatars have learnt
    planning: Executor = field(default_factory=planning_threads)  # of all sessions
    run: Path | None = None  # a recording that the page opens with
    meter: Meter = field(default_factory=Meter)  # what all sessions come to
    shelf: Shelf = field(default_factory=OwnShelf)  # what must outlast a session
    shared: bool = False  # whether other servers have the same shelf
    vmc: VmcStream | None = None  # where what is shown is sent too
    places: PlaceFiles = field(default_factory=lambda: PlaceFiles(Path()))
    sent: SentScenes = field(default_factory=lambda: SentScenes(PlaceFiles(Path())))  # by pages
    _styled: dict[str, MotionSet] = field(default_factory=dict)  # the same in a style, by its name
    warm: Event = field(default_factory=Event)  # set when every kernel has been loaded: until then plans wait for some

    @classmethod
    def open(
        cls,
        scene: str | Scene = "a",
        avatar: Path | None = None,
        walk: WalkSettings | None = None,
        motions: MotionSet | None = None,
        read: LoadSettings | None = None,
    ) -> "Library":
        """The stock scenes and avatar, and those asked for; raises `InputError` if one cannot be read."""
        first = load_scene(scene) if isinstance(scene, str) else scene
        scenes = {name: Scene.load(name) for name in Scene.stock_names()}
        avatars = AvatarStore()
        try:
            chosen = STOCK if avatar is None else avatars.add_file(avatar, read).id
        except BaseException:
            avatars.close()
            raise
        places = PlaceFiles(avatars.folder)
        first = places.shown(first)
        return cls(
            avatars,
            {first.name: first} | scenes | {first.name: first},
            first.name,
            chosen,
            walk or WalkSettings(),
            motions=motions or MotionSet(),
            places=places,
            sent=SentScenes(places),
        )

    def close(self) -> None:
        """Remove the files that the avatars lie in; plans in the making end unheard."""
        self.planning.shutdown(wait=False, cancel_futures=True)
        self.avatars.close()

    async def find_scene(self, name: str, client: Hashable) -> Scene:
        """A scene of this server, or a random course for a client. Raises as `check_scene` and `Courses.find`."""
        self.check_scene(name)
        known = self.scenes.get(name) or self.sent.get(name)
        return known if known is not None else await self.courses.find(name, client)

    def motions_in(self, style: str) -> MotionSet:
        """What avatars have learnt, in a stock style: the same ones for all who ask, so that they share models."""
        if style == self.motions.style.name:
            return self.motions
        return self._styled.setdefault(style, replace(self.motions, style=STYLES[style]))

    def hold(self, user: Hashable, *shown: "Wanted") -> None:
        """This is what a session shows from now on, or will in a moment: it stays here. Nothing: it has ended."""
        self.avatars.hold(user, *(wanted.avatar for wanted in shown))
        self.clips.hold(user, *(wanted.clip for wanted in shown))
        self.sent.hold(user, *(wanted.scene for wanted in shown))

    def files(self) -> set[Path]:
        """The files of what clients sent and this server keeps."""
        return self.avatars.files() | self.clips.files() | self.places.files()

    def check_scene(self, name: str) -> None:
        """Raises `InputError` if there is no scene and no course of this name."""
        if name in self.scenes or self.sent.get(name) is not None:
            return
        if not name.startswith(PREFIX):
            known = ", ".join(self.scenes)
            raise InputError(f"scene {name[:40]!r} is not known here; there are {known}, dropped models, and {NAMED}")
        parse_name(name)

    @cached_property
    def _scene_choices(self) -> list[SceneChoice]:
        known = [SceneChoice(name, scene.title) for name, scene in self.scenes.items()]
        courses = {name: f"Random course, level {parse_name(name)[0]}" for name in random_names()}
        return known + [SceneChoice(name, title) for name, title in courses.items() if name not in self.scenes]

    def catalog(self, owner: str = "") -> Catalog:
        """What the menus offer now to the page with this key; files that other pages sent are not in it."""
        return Catalog(
            scenes=self._scene_choices,
            avatars=self.avatars.choices(owner),
            planners=list(planner_names()),
            queue_sizes=list(QUEUE_SIZES),
            walk_speed=WALK_SPEEDS,
            styles=[StyleChoice(style.name, style.speed) for style in STYLES.values()],
            clips=self.clips.choices(owner),
        )
