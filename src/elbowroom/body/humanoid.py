"""Who moves: a humanoid avatar, read from a file or the stock one."""

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from elbowroom.body.capsules import Capsules
from elbowroom.body.loading.permissions import Permissions
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.rig import Rig
from elbowroom.body.skeleton import Skeleton
from elbowroom.body.soles import Soles


@dataclass(frozen=True)
class BoneSource:
    """Where a bone was found."""

    bone: str
    node: int  # of the file
    name: str  # of the node
    how: str  # "VRM 1.0", a table of names ("Mixamo", ...), "spelling", "topology", "override", "added"


@dataclass(frozen=True)
class AvatarMeta:
    """What the file says about itself; empty strings where it is silent."""

    title: str = ""
    authors: tuple[str, ...] = ()
    licence: str = ""
    format: str = ""  # "VRM 1.0", "VRM 0.x", "glTF 2.0"
    notes: tuple[str, ...] = ()  # what was left out or guessed in reading it, one line each
    bones: tuple[BoneSource, ...] = ()  # parents first
    contact: str = ""
    permissions: Permissions = field(default_factory=Permissions)
    has_body: bool = True  # False: its mesh, if any, is on few of the bones: a token, a ball on a rig


@dataclass(frozen=True, eq=False)
class Humanoid:
    """An avatar: skeleton, collision body, and the rig of the file that it came from."""

    name: str  # of the file, or of the stock avatar
    skeleton: Skeleton  # joints, their parents and places in the T-pose
    capsules: Capsules  # the collision body: it holds the skin
    rig: Rig | None = None  # None for a humanoid that has no file
    source: Path | None = None  # the file
    meta: AvatarMeta = field(default_factory=AvatarMeta)  # title, author, licence, how each bone was found
    settings: LoadSettings = field(default_factory=LoadSettings)  # that it was read with; the bones that were told
    glb: bytes | None = None  # the file as one self-contained GLB, for a viewer; None without a file
    soles: Soles | None = None  # how its feet roll; None: as those of average proportions

    @classmethod
    def load(cls, path: str | Path, settings: LoadSettings | None = None) -> "Humanoid":
        """Read a VRM 0.x, VRM 1.0, glTF/GLB or H-Anim (X3D, VRML97) humanoid.

        Raises `InputError` if the file cannot be read or holds no humanoid.
        """
        from elbowroom.body.loading.avatar_file import load_humanoid

        return load_humanoid(Path(path), settings)

    @classmethod
    def default(cls) -> "Humanoid":
        """The stock avatar, which comes with the package: read once, and one and the same for all who ask."""
        return _stock_avatar()


@cache
def _stock_avatar() -> Humanoid:
    from elbowroom.body.stock import stock_avatar_path

    return Humanoid.load(stock_avatar_path())
