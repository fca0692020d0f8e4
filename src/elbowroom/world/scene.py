"""Where: obstacles, ground, a start and a finish."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.formats.foreign_files import foreign_document, foreign_kind
from elbowroom.formats.models.kinds import kind_by_name
from elbowroom.world.ground.ground import Ground, eased_height
from elbowroom.world.ground.making import ground_of
from elbowroom.world.json_place import parse_json, read_json
from elbowroom.world.obstacles.free_map import FreeMap
from elbowroom.world.obstacles.lent_map import LentMap
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.scene_place import ScenePlace
from elbowroom.world.stock_scenes import check_scene_name, stock_folder, stock_names
from elbowroom.world.stops import Stop

MAX_FILE_BYTES = 16 * 2**20
_SCENES_ARE = "a scene is a JSON file or a model of a place: glTF, X3D, VRML97, OBJ, STL, PLY or USD (docs/scenes.md)"


@dataclass(frozen=True)
class Gate:
    """A line on the ground to cross: `heading` is the direction of crossing, `width` the length of the line."""

    position: tuple[float, float]  # middle of the line: x, z, metres
    heading: float = 0.0  # radians
    width: float = 4.0  # metres

    def passed(self, x: float, z: float) -> bool:
        """Whether a point on the ground lies behind the line, within its width."""
        dx, dz = x - self.position[0], z - self.position[1]
        sine, cosine = math.sin(self.heading), math.cos(self.heading)
        return dx * sine + dz * cosine >= 0.0 and abs(dx * cosine - dz * sine) <= 0.5 * self.width


@dataclass(frozen=True, eq=False)
class Scene:
    """A place to walk through; it never changes. `Scene.load` reads one, stock or from a file."""

    name: str  # as in `--scene NAME`
    title: str  # shown to people
    description: str  # a sentence or two; may be empty
    ground_center: tuple[float, float]  # x, z, metres
    ground_size: tuple[float, float]  # extent along x and z, metres
    start: RootState  # where an avatar is put
    finish: Gate  # the line that ends the walk
    obstacles: Obstacles = field(default_factory=Obstacles)  # all that stands or moves in the way
    place: ScenePlace | None = None  # the model that the scene shows; its parts are the first of the obstacles
    colors: Mapping[str, str] = field(default_factory=dict)  # "#rrggbb" by the name of an obstacle, where it has one
    tour: tuple[Stop, ...] = ()  # where a guided tour stops, in order

    @classmethod
    def load(
        cls,
        name_or_path: str | Path,
        options: PlaceOptions | None = None,
        progress: Callable[[str, float], None] = lambda _what, _share: None,
    ) -> "Scene":
        """A stock scene by its name (`"a"`, in either case), a scene file (JSON) or a model of a place by its path.

        `options` tell how a model is to be read; `progress` hears what is done and which share of it. Raises
        `InputError` if there is no such scene, or the file breaks the published schema
        (`elbowroom/world/data/scene.schema.json`), or its start stands in an obstacle, or the model cannot be read.
        """
        check_scene_name(name_or_path)
        stock = None if isinstance(name_or_path, Path) else name_or_path.lower()
        model = stock not in stock_names() and kind_by_name(Path(name_or_path).name) is not None
        if not model and options is not None and options != PlaceOptions():
            told = 'is told in the scene\'s own "place" (docs/scenes.md)'
            raise InputError(f"{name_or_path}: how a model is read {told}")
        if stock in stock_names():
            source = f"{stock}.json"
            return cls.from_dict(parse_json((stock_folder() / source).read_text("utf-8"), source), source)
        path = Path(name_or_path)
        if model:
            from elbowroom.world.places.place_scene import load_place_scene

            return load_place_scene(path, options or PlaceOptions(), progress)
        return cls.from_dict(_read(path), str(path), path.parent)

    @staticmethod
    def stock_names() -> tuple[str, ...]:
        """The names of the scenes that come with the package: the paper's four first."""
        return stock_names()

    @classmethod
    def from_dict(cls, document: Any, source: str = "scene", folder: Path | None = None) -> "Scene":
        """A scene from a parsed JSON document; `source` is how error messages call it. Raises `InputError`.

        `folder` is where the model lies that the document may name.
        """
        from elbowroom.world.scene_format import read_scene

        return read_scene(document, source, folder)

    @classmethod
    def of(
        cls,
        name: str,
        obstacles: Sequence[Mapping[str, Any]],
        *,
        finish: tuple[float, float],
        start: tuple[float, float] = (0.0, 0.0),
        moving: Sequence[Mapping[str, Any]] = (),
    ) -> "Scene":
        """A scene made in code: from `start` to `finish` (x, z, metres), on ground that reaches 8 m around both.

        The avatar faces the finish, which is a line of 4 m across its way. Obstacles are told as in a scene file:
        `{"type": "box", "center": [x, y, z], "size": [x, y, z]}`, with `"yaw"` in radians and `"name"` if need be;
        so are those that move. Raises `InputError`, as `from_dict` does.
        """
        from elbowroom.world.scene_format import scene_document

        return cls.from_dict(scene_document(name, obstacles, start, finish, moving), name)

    @cached_property
    def ground(self) -> Ground:
        """What feet stand on: the plane at height 0, and all that is flat enough and reached from there by steps.

        In the model of a place there is no plane beyond its floor.
        """
        return ground_of(self.obstacles, self.place.floor if self.place else None)

    @property
    def free_map(self) -> FreeMap:
        """How far away what stands is, over the ground: one map for all who walk here, while they hold it."""
        return self.obstacles.free_map if self.ground.plain else self._lent_map.take()

    @cached_property
    def _lent_map(self) -> LentMap:
        return LentMap(self.obstacles.near, self.ground)

    def to_dict(self) -> dict[str, Any]:
        """The JSON document of the scene: `Scene.from_dict(scene.to_dict())` is the same scene."""
        from elbowroom.world.scene_format import write_scene

        return write_scene(self)

    def finished(self, root: RootState) -> bool:
        """Whether the avatar has crossed the finish gate."""
        return self.finish.passed(root.x, root.z)


def on_ground(scene: Scene, root: RootState) -> RootState:
    """A root state at the height of the ground about it, of that which is nearest to its own height."""
    if scene.ground.plain:
        return root  # told without a kernel, which may have to be compiled
    height = eased_height(scene.ground, (root.x, root.height, root.z), root.x, root.z)
    return root._replace(height=height) if math.isfinite(height) else root


def _read(path: Path) -> Any:
    """The JSON document in a file; raises `InputError`, also for what is known to be something else."""
    try:
        kind = foreign_kind(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    document = None if kind else read_json(path, MAX_FILE_BYTES)
    if kind := kind or foreign_document(document):
        raise InputError(f"{path}: is {kind}; {_SCENES_ARE}")
    return document
