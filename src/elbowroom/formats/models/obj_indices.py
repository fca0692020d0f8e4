"""OBJ whose faces count their corners back from where they stand: counted from the front, as trimesh takes them."""

import re
from collections.abc import Iterable

_BACK = re.compile(rb"^[ \t]*[fl][ \t].*-\d", re.MULTILINE)
_NOTHING = 999_999_999
_KINDS = (b"v", b"vt", b"vn")  # in the order of a corner's numbers


def counted_from_the_front(data: bytes) -> bytes:
    """The file with every index positive; itself, where all are.

    `-1` is what was told last before the face. One that leads before the first becomes one that nothing has.
    """
    if not _BACK.search(data):
        return data
    told, lines = dict.fromkeys(_KINDS, 0), []
    for line in data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines():
        words = line.split()
        if words and words[0] in told:
            told[words[0]] += 1
        elif words and words[0] in (b"f", b"l") and b"-" in line:
            counts = tuple(told.values())
            lines.append(b" ".join([words[0], *(_corner(word, counts) for word in words[1:])]))
            continue
        lines.append(line)
    return b"\n".join(lines)


def _corner(word: bytes, counts: Iterable[int]) -> bytes:
    """A corner such as `-4/-4/-1`, after so many of each kind."""
    numbers = word.split(b"/")
    return b"/".join(_index(number, count) for number, count in zip(numbers, counts, strict=False))


def _index(number: bytes, count: int) -> bytes:
    if not number.startswith(b"-") or not number[1:].isdigit():
        return number
    index = count + 1 - int(number[1:9])
    return b"%d" % (index if index > 0 else _NOTHING)
