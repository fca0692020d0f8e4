"""Opens a USD stage, and no file that is not the model's own or in its folder."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from elbowroom.errors import InputError

_MOST_LAYERS = 1000
_DAMAGED = "is no USD file that can be read: it is damaged or cut off; save it again"
_BINARY, _PACKED = b"PXR-USDC", b"PK\x03\x04"


@contextmanager
def opened_stage(data: bytes, name: str, folder: Path | None) -> Iterator[Any]:
    """The stage of a file; `folder` is where it lies, with files that it may name (None for an upload: it names none).

    Raises `InputError`.
    """
    try:
        from pxr import Sdf, Usd, UsdUtils
    except ImportError:
        raise InputError(f"{name}: models in USD need usd-core: pip install 'elbowroom[usd]'") from None
    silent = UsdUtils.CoalescingDiagnosticDelegate()  # what it says of a damaged file, we say in one line
    with _lying(data, name, folder) as file:
        try:
            layer = Sdf.Layer.FindOrOpen(str(file))
            if layer is None:
                raise InputError(f"{name}: {_DAMAGED}")
            _check_layers(layer, name, folder)
            stage = Usd.Stage.Open(layer, Usd.Stage.LoadAll)
        except (InputError, MemoryError):
            raise
        except Exception:  # whatever the library raises, the file is not what it should be
            raise InputError(f"{name}: {_DAMAGED}") from None
        yield stage
    del silent


@contextmanager
def _lying(data: bytes, name: str, folder: Path | None) -> Iterator[Path]:
    """The file on disk; bytes that were sent to us are put in a folder of their own for so long."""
    if folder is not None:
        yield folder / name
        return
    ending = ".usdc" if data.startswith(_BINARY) else ".usdz" if data.startswith(_PACKED) else ".usda"
    with tempfile.TemporaryDirectory(prefix="elbowroom-usd-") as own:
        file = Path(own) / f"model{ending}"
        file.write_bytes(data)
        yield file


def _check_layers(layer: Any, name: str, folder: Path | None) -> None:
    """Raises `InputError` if a layer, or one that it is composed of, is in a file elsewhere."""
    from pxr import Sdf

    waiting, seen = [layer], {layer.identifier}
    while waiting:
        current = waiting.pop()
        for asset in current.GetCompositionAssetDependencies():
            path = current.ComputeAbsolutePath(asset)
            if path in seen:
                continue
            if folder is None and not _is_inside(path, layer):
                raise InputError(f"{name}: names {asset[:60]!r}: it must be one file (.usdz, or as `usdcat --flatten`)")
            if folder is not None and not Path(_outer(path)).resolve().is_relative_to(folder.resolve()):
                raise InputError(f"{name}: names {asset[:60]!r}: only files in the model's own folder are read")
            seen.add(path)
            if len(seen) > _MOST_LAYERS:
                raise InputError(f"{name}: is made of more than {_MOST_LAYERS} files")
            found = Sdf.Layer.FindOrOpen(path)
            if found is not None:
                waiting.append(found)


def _outer(path: str) -> str:
    """The file of a layer: `model.usdz[inner.usdc]` lies in `model.usdz`."""
    return path.split("[", 1)[0]


def _is_inside(path: str, layer: Any) -> bool:
    """Whether a layer lies in the same package."""
    return "[" in path and _outer(path) == _outer(layer.realPath or layer.identifier)
