"""Which avatar a recording was made with: the stock one, or a file known by its content."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.stock import stock_avatar_path
from elbowroom.errors import InputError


@dataclass(frozen=True)
class AvatarReference:
    """Name and content hash of an avatar; `stock` is the one that comes with the package."""

    name: str
    stock: bool
    sha256: str  # of the file; empty for an avatar without one
    path: str  # where the file was; empty for an avatar without one
    height: float | None = None  # metres that were asked for
    include_hair: bool = False
    bones: dict[str, int | None] = field(default_factory=dict, hash=False)  # nodes that the user told

    @classmethod
    def of(cls, humanoid: Humanoid) -> "AvatarReference":
        """How to find this humanoid again."""
        if humanoid.source is None:
            return cls(humanoid.name, False, "", "")
        stock = humanoid.source.resolve() == stock_avatar_path().resolve()
        path, read = "" if stock else str(humanoid.source), humanoid.settings
        told: dict[str, Any] = dict(read.bones) if isinstance(read.bones, Mapping) else {}
        return cls(humanoid.name, stock, _sha256(humanoid.source), path, read.height, read.include_hair, told)

    def load(self, path: Path | None = None) -> Humanoid:
        """The avatar, from `path` where it is given.

        Raises `InputError` where a file is needed and not given, or holds something else than was recorded.
        """
        if path is None and self.stock:
            path = stock_avatar_path()
        elif path is None:
            raise InputError(f"the recording was made with the avatar {self.name} ({self.path}): give it with --avatar")
        humanoid = Humanoid.load(path, LoadSettings(self.bones, self.include_hair, self.height))
        if _sha256(path) != self.sha256:
            raise InputError(f"{path}: is not the avatar {self.name} that was recorded (SHA-256 {self.sha256[:16]}…)")
        return humanoid


def _sha256(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
