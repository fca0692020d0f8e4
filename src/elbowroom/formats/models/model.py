"""A model of any format that is read: what it shows as glTF, which is also what a viewer is given."""

from dataclasses import dataclass
from pathlib import Path

from elbowroom.errors import InputError
from elbowroom.formats.file_bytes import read_file
from elbowroom.formats.foreign_files import told_apart
from elbowroom.formats.gltf import Gltf, parse_gltf
from elbowroom.formats.models.kinds import ModelKind, kind_of
from elbowroom.formats.models.said import Said

MAX_BYTES = 200 * 2**20  # of a model's file


@dataclass(frozen=True, eq=False)
class Model:
    """What a file shows."""

    gltf: Gltf
    kind: ModelKind
    data: bytes  # the file, as it is
    notes: tuple[str, ...]  # what was left out in reading it
    said: Said | None = None  # of units and axes, by the file itself


def read_model(path: Path) -> Model:
    """Read a model and what it names in its own folder; raises `InputError`."""
    return parse_model(read_file(path, MAX_BYTES), path.name, path.parent)


def parse_model(data: bytes, name: str, folder: Path | None = None) -> Model:
    """The same for bytes; `folder` is where files that they name may lie (none for an upload)."""
    if len(data) > MAX_BYTES:
        raise InputError(f"{name}: has {len(data) >> 20} MB; at most {MAX_BYTES >> 20} MB are read")
    kind = kind_of(data, name)
    match kind:
        case ModelKind.GLTF:
            return Model(parse_gltf(data, name, folder), kind, data, ())
        case ModelKind.X3D:
            from elbowroom.formats.hanim.figure import parse_scenery

            return Model(*_with(kind, data, *parse_scenery(data, name, folder)))
        case ModelKind.OBJ | ModelKind.STL | ModelKind.PLY:
            from elbowroom.formats.models.loose_triangles import parse_loose_triangles

            return Model(*_with(kind, data, *parse_loose_triangles(data, kind, name, folder)))
        case ModelKind.USD:
            from elbowroom.formats.models.usd.as_gltf import parse_usd_scene

            gltf, said = parse_usd_scene(data, name, folder)
            return Model(gltf, kind, data, (), said)
    formats = ", ".join(each.value for each in ModelKind)
    raise InputError(told_apart(name, data, f"it is no model of a format that is read ({formats})"))


def _with(
    kind: ModelKind, data: bytes, gltf: Gltf, notes: tuple[str, ...]
) -> tuple[Gltf, ModelKind, bytes, tuple[str, ...]]:
    return gltf, kind, data, notes
