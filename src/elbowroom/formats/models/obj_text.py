"""OBJ as trimesh takes it: words apart by blanks, lines by line feeds, corners of faces counted from the front.

Faces have no dents.
"""

import re
from collections.abc import Iterable

from elbowroom.formats.models.obj_polygons import without_dents

# Corners may count back from where the face stands; none is called 0, which trimesh would take for the last.
_BACK_OR_NONE = re.compile(rb"^ *[fl](?: .*)?(?:[ /]-\d| 0(?:[ /]|$))", re.MULTILINE)
_NOTHING = 999_999_999
_KINDS = (b"v", b"vt", b"vn")  # in the order of a corner's numbers


def plain_obj(data: bytes) -> bytes:
    """The same file, plainer. An index that leads to nothing becomes one that nothing has."""
    data = data.replace(b"\t", b" ").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if not _BACK_OR_NONE.search(data):
        return without_dents(data)
    told, lines = dict.fromkeys(_KINDS, 0), []
    for line in data.replace(b"\\\n", b" ").split(b"\n"):
        words = line.split()
        if words and words[0] in (b"f", b"l"):
            counts = tuple(told.values())
            lines.append(b" ".join([words[0], *(_corner(word, counts) for word in words[1:])]))
            continue
        if words and words[0] in told:
            told[words[0]] += 1
        lines.append(line)
    return without_dents(b"\n".join(lines))


def _corner(word: bytes, counts: Iterable[int]) -> bytes:
    """A corner such as `-4/-4/-1`, after so many of each kind."""
    numbers = word.split(b"/")
    return b"/".join(_index(number, count) for number, count in zip(numbers, counts, strict=False))


def _index(number: bytes, count: int) -> bytes:
    digits = number.removeprefix(b"-")
    if not digits.isdigit():
        return number
    told = int(digits[:9])
    index = count + 1 - told if number.startswith(b"-") else told
    return b"%d" % (index if index > 0 else _NOTHING)
