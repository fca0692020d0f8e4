"""X3D and VRML files, packed or not, and the files beside them that they name; never an address, never elsewhere."""

import zlib
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

from elbowroom.errors import InputError
from elbowroom.formats.fields import beginning_of
from elbowroom.formats.file_bytes import read_file
from elbowroom.formats.x3d.classic import parse_classic
from elbowroom.formats.x3d.model import Interface, Node, Notes, X3dScene
from elbowroom.formats.x3d.recognised import GZIP, UTF16
from elbowroom.formats.x3d.xml import parse_xml

MAX_BYTES = 64 * 2**20  # of one file unpacked, and of all files that one scene takes in
_MAX_FILES = 200
_CLASSIC = (b"#VRML V2.0", b"#X3D V")


def parse_x3d(data: bytes, file: str, notes: Notes) -> X3dScene:
    """The scene of a file as it was written; raises `InputError`."""
    data = unpacked(data, file)
    head = data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")
    if head.startswith(b"#VRML V1"):
        raise InputError(f'{file} is VRML 1.0: only VRML97 ("#VRML V2.0") and X3D are read; convert it')
    if head.startswith(_CLASSIC):
        return parse_classic(_decoded(data), file, notes)
    if head.startswith(b"<") or data[:2] in UTF16:
        return parse_xml(data, file, notes)
    raise InputError(f"{file}{beginning_of(data)}: VRML97 starts with '#VRML V2.0 utf8', X3D with '#X3D' or '<'")


def unpacked(data: bytes, file: str) -> bytes:
    """The bytes, taken out of gzip if they are in it; raises `InputError` beyond `MAX_BYTES`."""
    if data[:2] == GZIP:
        stream = zlib.decompressobj(wbits=31)
        try:
            data = stream.decompress(data, MAX_BYTES + 1)
        except zlib.error:
            raise InputError(f"{file}: it cannot be unpacked: its gzip data are damaged") from None
        if not stream.eof and len(data) <= MAX_BYTES:
            raise InputError(f"{file}: it cannot be unpacked: the file was cut off")
    if len(data) > MAX_BYTES:
        raise InputError(f"{file} has more than {MAX_BYTES >> 20} MB of text")
    return data


class FilesBeside:
    """The files beside a scene that it may take in; a node's `file` is its path below the scene's folder."""

    def __init__(self, folder: Path | None, notes: Notes) -> None:
        self._folder, self._notes = folder, notes
        self._scenes: dict[str, X3dScene | None] = {}
        self._bytes = 0

    def open(self, urls: tuple[str, ...], node: Node) -> X3dScene | None:
        """The first scene of these that lies beside the file; None, and a note, if there is none."""
        for url in urls:
            path = self._beside(url.partition("#")[0], node)
            if path is not None:
                return self._scene(path, node)
        self._missing(urls, node)
        return None

    def picture(self, urls: tuple[str, ...], node: Node) -> bytes | None:
        """The bytes of the first of these files that lies beside the scene; None, and a note, if there is none."""
        for url in urls:
            path = self._beside(url, node)
            if path is not None:
                return self._read(path, node)
        self._missing(urls, node)
        return None

    def find_proto(self, proto: Interface, node: Node) -> Interface | None:
        """The PROTO that an EXTERNPROTO means; None, and a note, if no file beside the scene has it."""
        urls = proto.urls or ()
        for url in urls:
            file, _, name = url.partition("#")
            path = self._beside(file, node)
            scene = self._scene(path, node) if path is not None else None
            if scene is not None:
                found = scene.protos.get(name) if name else next(iter(scene.protos.values()), None)
                if found is not None and found.urls is None:
                    return found
        self._missing(urls, node)
        return None

    def _beside(self, url: str, node: Node) -> str | None:
        """The path below the scene's folder that a URL means, if a file is there."""
        name = unquote(url.strip())
        if self._folder is None or not name or len(name) > 500:
            return None
        if not _may_be_beside(name):
            return None
        path = PurePosixPath(node.file).parent / name
        try:
            there = (self._folder / path).resolve()
            inside = there.is_relative_to(self._folder.resolve()) and there.is_file()
        except (OSError, ValueError):
            return None
        return str(there.relative_to(self._folder.resolve()).as_posix()) if inside else None

    def _read(self, path: str, node: Node) -> bytes:
        if self._folder is None:
            raise InputError(f"{node.place}: no other files can be read here")
        data = read_file(self._folder / path, MAX_BYTES)
        self._bytes += len(data)
        if self._bytes > MAX_BYTES:
            raise InputError(f"{node.place}: the files beside the scene have more than {MAX_BYTES >> 20} MB")
        return data

    def _scene(self, path: str, node: Node) -> X3dScene | None:
        if path not in self._scenes:
            if len(self._scenes) >= _MAX_FILES:
                raise InputError(f"{node.place}: the scene takes in more than {_MAX_FILES} files")
            self._scenes[path] = None
            data = unpacked(self._read(path, node), path)
            self._bytes += len(data)
            self._scenes[path] = parse_x3d(data, path, self._notes)
        return self._scenes[path]

    def _missing(self, urls: tuple[str, ...], node: Node) -> None:
        wanted = urls[0][:60] if urls else ""
        if self._folder is None:
            why = "a file that is sent alone has none beside it"
        elif any(_may_be_beside(unquote(url.strip())) and ".." not in url for url in urls):
            why = "there is no such file beside the scene"
        else:
            why = "only files beside the scene are read"
        self._notes.add(f"{node.place}: {wanted!r} is left out: {why}")


def _may_be_beside(name: str) -> bool:
    """Whether a name without escapes is that of a file near the scene, not an address of elsewhere."""
    return bool(name) and not (":" in name or "\\" in name or "\x00" in name or name.startswith("/"))


def _decoded(data: bytes) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")
