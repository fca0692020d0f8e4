"""OBJ, STL and PLY as glTF, read by trimesh: formats that know neither a unit nor which way is up."""

import io
import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from elbowroom.errors import InputError
from elbowroom.formats.gltf import Gltf, parse_gltf
from elbowroom.formats.models.kinds import ModelKind
from elbowroom.formats.models.obj_text import plain_obj
from elbowroom.formats.models.ply.polygons import in_triangles

_MOST_BESIDE = 64 * 2**20  # bytes of materials and pictures beside a model, in all


def parse_loose_triangles(data: bytes, kind: ModelKind, name: str, folder: Path | None) -> tuple[Gltf, tuple[str, ...]]:
    """The model as glTF, and notes; `folder` is where its materials and pictures may lie. Raises `InputError`."""
    import trimesh

    beside = _Beside(folder)
    options: dict[str, Any] = {}
    if kind is ModelKind.OBJ:
        data, options = plain_obj(data), {"split_objects": True, "split_groups": True}
    if kind is ModelKind.PLY:
        data = in_triangles(data)
    load: Any = trimesh.load_scene  # which takes whatever can be asked for files as `beside` can
    try:
        with _silent():
            scene = load(io.BytesIO(data), file_type=kind.name.lower(), resolver=beside, process=False, **options)
            if not any(len(getattr(mesh, "faces", ())) for mesh in scene.geometry.values()):
                raise InputError(f"{name}: there are no triangles in this {kind.value} file")
            glb = scene.export(file_type="glb")
    except (InputError, MemoryError):  # of the latter who has bounded memory tells
        raise
    except Exception as error:  # whatever the library raises, the file is not what it should be
        raise InputError(f"{name}: is no {kind.value} file that can be read ({_in_short(error)})") from None
    return parse_gltf(glb, name), tuple(beside.missing)


@contextmanager
def _silent() -> Iterator[None]:
    """Whatever the library thinks of a damaged file is told by us, in one line."""
    log = logging.getLogger("trimesh")
    before = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            yield
    finally:
        log.setLevel(before)


def _in_short(error: Exception) -> str:
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said[:80]}" if said else type(error).__name__


class _Beside:
    """Hands the library files that lie in the model's own folder, and remembers which it did not get."""

    def __init__(self, folder: Path | None) -> None:
        self._folder = None if folder is None else folder.resolve()
        self._left = _MOST_BESIDE
        self.missing: list[str] = []

    def __getitem__(self, name: str | bytes) -> bytes:
        return self.get(name)

    def get(self, name: str | bytes) -> bytes:
        """The bytes of a file beside the model; raises FileNotFoundError."""
        wanted = (name.decode("utf-8", "replace") if isinstance(name, bytes) else str(name)).strip()
        data = self._read(wanted)
        if data is None:
            note = f"{wanted[:60]!r} is left out: there is no such file in the model's folder"
            if note not in self.missing:
                self.missing.append(note)
            raise FileNotFoundError(wanted)
        self._left -= len(data)
        return data

    def _read(self, name: str) -> bytes | None:
        if self._folder is None or not name or len(name) > 500 or "\x00" in name:
            return None
        try:
            path = (self._folder / name.replace("\\", "/")).resolve()
            if not path.is_relative_to(self._folder) or not path.is_file() or path.stat().st_size > self._left:
                return None
            return path.read_bytes()
        except OSError:
            return None

    def keys(self) -> list[str]:
        """The library asks which files there are; it is told of those that it names."""
        return []

    def namespaced(self, _namespace: str) -> "_Beside":
        """The same folder."""
        return self
