"""What a glTF file may refer to: data in the URI, or a file in its own folder; never a network or outside path."""

import base64
import binascii
from pathlib import Path
from urllib.parse import unquote, unquote_to_bytes

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field


def read_uri(field: Field, folder: Path | None, most: int) -> bytes:
    """The bytes behind a `uri` field, at most `most` of them; raises `InputError`."""
    uri = field.value
    if not isinstance(uri, str):
        raise field.wrong("a text")
    if uri.startswith("data:"):
        return _data_uri(field, uri)
    if folder is None:
        raise field.wrong("embedded in the file (save it as one .glb)")
    return _neighbour(field, unquote(uri), folder, most)


def _data_uri(field: Field, uri: str) -> bytes:
    head, comma, body = uri.partition(",")
    if not comma:
        raise field.wrong("a data URI with a comma before its data")
    if not head.endswith(";base64"):
        return unquote_to_bytes(body)
    try:
        return base64.b64decode(unquote(body), validate=True)
    except (binascii.Error, ValueError):
        raise field.wrong("a data URI with valid base64") from None


def _neighbour(field: Field, name: str, folder: Path, most: int) -> bytes:
    rule = "a file in the same folder"
    if ":" in name or "\\" in name or "\x00" in name or name.startswith("/") or ".." in Path(name).parts:
        raise field.wrong(rule)
    try:
        path = (folder / name).resolve()
        if not path.is_relative_to(folder.resolve()):
            raise field.wrong(rule)
        if not path.is_file():
            raise InputError(f"{field.place}: there is no file {name!r} beside it")
        if path.stat().st_size > most:
            raise InputError(f"{field.place}: {name!r} is larger than {most >> 20} MB")
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{field.place}: {name!r} cannot be read: {error.strerror or error}") from None
