"""The prims of a USD layer in text, with their attributes and relationships (openusd.org, "USD file format: usda").

Only what stands in this layer is read: references, payloads, sub-layers and variants are passed by.
"""

import re
from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError

Floats = NDArray[np.float64]
Value = Floats | tuple[str, ...]  # numbers, however they are nested, in a row; names, texts or paths

MAX_BYTES = 64 * 2**20
_MAX_PRIMS = 50_000
_MAX_DEPTH = 200
_MAX_SAMPLES = 200_000  # of one attribute
_LARGEST = 1e9
_BINARY = (b"PXR-USDC", b"PK\x03\x04")
_GAP = re.compile(r"(?:[\s;,]+|#[^\n]*|//[^\n]*|/\*.*?\*/)*", re.DOTALL)
_TEXT = r'"""(?:[^\\]|\\.)*?"""|\'\'\'(?:[^\\]|\\.)*?\'\'\'|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\''
_ASSET = r"@@@.*?@@@|@[^@\n]*@"
_TOKEN = re.compile(
    rf"(?P<text>{_TEXT})|(?P<asset>{_ASSET})|(?P<path><[^<>\n]*>)|(?P<word>[A-Za-z_!][\w:!]*(?:\.[A-Za-z]\w*)?(?:\[\])?)"
    r"|(?P<number>[-+]?(?:inf|nan|[\d.][\w.]*(?:(?<=[eE])[-+]\d+)?))|(?P<sign>[(){}\[\]=:.&|*])",
    re.DOTALL,
)
_NESTED = re.compile(rf"{_TEXT}|{_ASSET}|[(){{}}\[\]]", re.DOTALL)
_NAMED = re.compile(rf"{_TEXT}|{_ASSET}|<[^<>\n]*>", re.DOTALL)
_FLAT = str.maketrans("()[],", "     ")
_CLOSED = {"(": ")", "[": "]", "{": "}"}
_LISTED = ("prepend", "append", "add", "delete", "reorder", "custom", "uniform", "varying", "config")


@dataclass(eq=False)
class Attribute:
    """What a property says: its value, and its values over time by time code."""

    value: Value | None = None
    samples: dict[float, Value] = field(default_factory=dict)


@dataclass(eq=False)
class Prim:
    """One prim; the layer itself is one without a name, whose attributes are its metadata."""

    file: str
    kind: str  # "SkelAnimation", "Xform", ...; "" for `over` and `def` without a type
    name: str
    path: str  # "/avatar/skeleton"
    title: str = ""  # displayName
    attributes: dict[str, Attribute] = field(default_factory=dict)
    children: list["Prim"] = field(default_factory=list)

    def value(self, name: str) -> Value | None:
        """The value of an attribute outside of time."""
        return self.attributes[name].value if name in self.attributes else None

    def number(self, name: str, default: float) -> float:
        """One number; raises `InputError` for anything else."""
        value = self.value(name)
        if value is None:
            return default
        if isinstance(value, tuple) or len(value) != 1:
            raise InputError(f"{self.file}: {self.path}.{name} must be one number")
        return float(value[0])

    def texts(self, name: str) -> tuple[str, ...]:
        """Names, texts or paths."""
        value = self.value(name)
        return value if isinstance(value, tuple) else ()


def is_usd(data: bytes) -> bool:
    """Whether these bytes begin like USD, in text or packed."""
    return data.startswith((b"#usda", *_BINARY[:1]))


def parse_usda(data: bytes, file: str) -> Prim:
    """The layer in a file; raises `InputError`."""
    if data.startswith(_BINARY):
        raise InputError(f"{file} is USD in its binary form: save it as text (.usda), or with `usdcat -o FILE.usda`")
    if len(data) > MAX_BYTES:
        raise InputError(f"{file} has more than {MAX_BYTES >> 20} MB of text")
    try:
        return _Parser(data.decode("utf-8"), file).layer()
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: byte {error.start} is not UTF-8 text") from None


class _Parser:
    def __init__(self, text: str, file: str) -> None:
        self._text, self._file, self._at, self._prims = text, file, 0, 0

    def layer(self) -> Prim:
        """The whole file."""
        layer = Prim(self._file, "", "", "")
        if self._sign("("):
            self._metadata(layer)
        waiting = [layer]  # open prims, the innermost last
        while waiting:
            found = self._statement(waiting[-1])
            if found is None:
                waiting.pop()
            elif found is not waiting[-1]:
                waiting.append(found)
                if len(waiting) > _MAX_DEPTH:
                    raise self._wrong(f"prims are nested more than {_MAX_DEPTH} deep")
        return layer

    def _statement(self, prim: Prim) -> Prim | None:
        """Read the next thing in a prim: a prim that begins, `prim` itself after a property, None at its end."""
        kind, word = self._next()
        if kind == "" or word == "}":
            if (kind == "") != (prim.path == ""):
                self._fail("a prim or '}'" if kind == "" else "a prim", word)
            return None
        if word in ("def", "over", "class"):
            return self._prim(prim)
        if word == "variantSet":
            self._next()
            self._expect("=")
            self._expect("{")
            self._skip("{")
        elif kind == "word" and word == "reorder":
            self._next()
            self._expect("=")
            self._value()
        elif kind == "word" and prim.path:
            self._property(prim, word)
        else:
            self._fail("def, over, class or a property", word)
        return prim

    def _prim(self, parent: Prim) -> Prim:
        kind, word = self._next()
        typed = word if kind == "word" else ""
        if typed:
            kind, word = self._next()
        if kind != "text":
            self._fail("the name of a prim in quotes", word)
        name = word[1:-1]
        self._prims += 1
        if self._prims > _MAX_PRIMS:
            raise self._wrong(f"more than {_MAX_PRIMS} prims")
        prim = Prim(self._file, typed, name, f"{parent.path}/{name}")
        parent.children.append(prim)
        if self._sign("("):
            self._metadata(prim, only="displayName")
        self._expect("{")
        return prim

    def _property(self, prim: Prim, word: str) -> None:
        """`[custom] [uniform] TYPE NAME = VALUE (metadata)`, or `rel NAME = ...`."""
        while word in _LISTED:
            kind, word = self._next()
        kind, name = self._next()
        if kind != "word":
            self._fail(f"the name of a property after {word[:40]}", name)
        name, dot, part = name.partition(".")
        known = prim.attributes.setdefault(name, Attribute())
        if self._sign("="):
            if part == "timeSamples":
                self._expect("{")
                self._samples(known)
            elif dot:
                self._value()  # of a connection, or of a spline
            else:
                known.value = self._value()
        if self._sign("("):
            self._skip("(")

    def _samples(self, known: Attribute) -> None:
        while not self._sign("}"):
            kind, word = self._next()
            if kind != "number" or len(known.samples) >= _MAX_SAMPLES:
                self._fail(f"at most {_MAX_SAMPLES} times as numbers, or '}}'", word)
            time = self._number(word)
            self._expect(":")
            value = self._value()
            if value is not None:
                known.samples[time] = value

    def _metadata(self, prim: Prim, only: str = "") -> None:
        """What stands in brackets behind a prim or at the head of a layer, up to the closing one."""
        while not self._sign(")"):
            kind, word = self._next()
            if kind == "text":  # a comment
                continue
            if kind != "word":
                self._fail("metadata or ')'", word)
            while word in _LISTED:
                kind, word = self._next()
            self._expect("=")
            value = self._value()
            if word == "displayName" and isinstance(value, tuple) and value:
                prim.title = " ".join(value[0].split())[:200]
            if not only:
                prim.attributes[word] = Attribute(value)

    def _value(self) -> Value | None:
        """A value; None for dictionaries and for nothing."""
        kind, word = self._next()
        if kind == "number":
            return np.array([self._number(word)])
        if kind in ("text", "path"):
            return (_bare(word),)
        if kind == "asset":
            if self._peek()[0] == "path":
                self._next()
            if self._sign("("):
                self._skip("(")
            return None
        if kind == "word":
            return {"true": np.ones(1), "false": np.zeros(1)}.get(word.lower())
        if word not in _CLOSED:
            self._fail("a value", word)
        inner = self._skip(word)
        if word == "{":
            return None
        return self._list(inner)

    def _list(self, inner: str) -> Value | None:
        """What stands between brackets: numbers, or names, texts and paths."""
        if '"' in inner or "'" in inner or "<" in inner or "@" in inner:
            return tuple(_bare(each) for each in _NAMED.findall(inner) if not each.startswith("@"))
        try:
            numbers = np.array(inner.translate(_FLAT).split(), dtype=np.float64)
        except ValueError:
            if "#" in inner or "/" in inner:
                raise self._wrong("comments within a list of numbers are not read") from None
            return None  # booleans and the like
        if len(numbers) and not float(np.abs(numbers).max()) <= _LARGEST:
            raise self._wrong(f"numbers must be finite and at most {_LARGEST:g}")
        return numbers

    def _number(self, word: str) -> float:
        try:
            number = float(word)
        except ValueError:
            self._fail("a number", word)
        if not abs(number) <= _LARGEST:
            raise self._wrong(f"numbers must be finite and at most {_LARGEST:g}")
        return number

    def _skip(self, opened: str) -> str:
        """What stands up to the sign that closes `opened`, which was just read."""
        first, open_ = self._at, [_CLOSED[opened]]
        for found in _NESTED.finditer(self._text, first):
            sign = found.group()
            if sign in _CLOSED:
                open_.append(_CLOSED[sign])
            elif sign == open_[-1]:
                open_.pop()
            elif len(sign) == 1:
                self._at = found.start()
                self._fail(repr(open_[-1]), sign)
            if not open_:
                self._at = found.end()
                return self._text[first : found.start()]
        raise self._wrong(f"the {opened!r} is never closed")

    def _peek(self) -> tuple[str, str]:
        at = self._at
        found = self._next()
        self._at = at
        return found

    def _sign(self, sign: str) -> bool:
        """Whether this sign is next; then it is taken."""
        at = self._at
        if self._next() == ("sign", sign):
            return True
        self._at = at
        return False

    def _expect(self, sign: str) -> None:
        found = self._next()
        if found != ("sign", sign):
            self._fail(repr(sign), found[1])

    def _next(self) -> tuple[str, str]:
        """Kind and text of the next token; empty at the end of the file."""
        gap = _GAP.match(self._text, self._at)
        at = gap.end() if gap else self._at
        if at >= len(self._text):
            self._at = at
            return "", ""
        token = _TOKEN.match(self._text, at)
        if token is None:
            self._at = at
            raise self._wrong(f"{self._text[at : at + 20]!r} is nothing that USD has")
        self._at = token.end()
        return str(token.lastgroup), token.group()

    def _fail(self, wanted: str, found: str) -> NoReturn:
        raise self._wrong(f"{wanted} should stand here, not {found[:40] or 'the end of the file'!r}")

    def _wrong(self, reason: str) -> InputError:
        return InputError(f"{self._file}: line {self._text.count(chr(10), 0, self._at) + 1}: {reason}")


def _bare(word: str) -> str:
    """A text without its quotes, a path without its brackets."""
    for quote in ('"""', "'''", '"', "'"):
        if word.startswith(quote):
            return re.sub(r"\\(.)", r"\1", word[len(quote) : -len(quote)], flags=re.DOTALL)
    return word[1:-1]
