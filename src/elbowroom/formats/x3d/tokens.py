"""The words of VRML97 and X3D Classic: names, numbers, texts and brackets, with the lines they stand in."""

import re
from bisect import bisect_right
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.x3d.numbers import (
    NotNumbersError,
    parse_number,
    parse_numbers,
    unescaped,
    without_comments,
)

_MAX_TOKENS = 500_000  # beside those in lists of numbers

_BLANK = r"(?:[\s,\ufeff]++|#[^\r\n]*+)*+"
_TOKEN = re.compile(
    _BLANK + r'(?:(?P<word>[^\s,"#\[\]{}]++)|(?P<text>"(?:[^"\\]|\\.)*+")|(?P<sign>[\[\]{}])|(?P<end>\Z)|(?P<open>"))',
    re.DOTALL,
)
_NUMBER_LIST = re.compile(_BLANK + r'((?:[^\[\]{}"#]++|#[^\r\n]*+)*+)\]')
_NAME_LETTER = re.compile(r"[G-WYZg-wyz_]")  # none of them is in a number, be it 1e-3 or 0xFF
_NUMERIC = frozenset("+-.0123456789")


class TokenKind(Enum):
    """What a token is."""

    WORD = "a name"
    NUMBER = "a number"
    TEXT = "a text"
    SIGN = "a bracket"
    END = "the end of the file"


class Token(NamedTuple):
    """A word of the file; a text is given without its quotes."""

    kind: TokenKind
    text: str
    start: int  # where it begins in the file


class Tokens:
    """Reads a text token by token, with one token of foresight."""

    def __init__(self, text: str, file: str) -> None:
        self._text, self._file = text, file
        self._at = 0
        self._count = 0
        self._lines: list[int] | None = None
        self._ahead: Token | None = None

    def line(self, start: int) -> int:
        """The line (from 1) of a place in the file."""
        if self._lines is None:
            self._lines = [match.end() for match in re.finditer(r"\r\n?|\n", self._text)]
        return bisect_right(self._lines, start) + 1

    def wrong(self, token: Token, wanted: str) -> InputError:
        """The error that says what stands at a token instead of what is wanted."""
        line = self.line(token.start)
        before = max(self._text.rfind("\n", 0, token.start), self._text.rfind("\r", 0, token.start))
        found = token.kind.value if token.kind is TokenKind.END else repr(token.text[:40])
        return InputError(f"{self._file}: line {line}, column {token.start - before}: {wanted} is needed, not {found}")

    def peek(self) -> Token:
        """The next token, which stays."""
        if self._ahead is None:
            self._ahead = self._read()
        return self._ahead

    def next(self) -> Token:
        """The next token, which is taken."""
        token = self.peek()
        self._ahead = None
        return token

    def word(self, wanted: str) -> str:
        """A name, whatever characters it begins with."""
        token = self.next()
        if token.kind not in (TokenKind.WORD, TokenKind.NUMBER):
            raise self.wrong(token, wanted)
        return token.text

    def sign(self, sign: str, where: str) -> None:
        """A bracket."""
        token = self.next()
        if token.kind is not TokenKind.SIGN or token.text != sign:
            raise self.wrong(token, f"{sign!r} {where}")

    def number_list(self) -> NDArray[np.float64] | None:
        """The numbers up to the `]` of a list whose `[` was just taken; None, and nothing taken, if it holds others."""
        if self._ahead is not None:
            return None
        match = _NUMBER_LIST.match(self._text, self._at)
        if match is None:
            return None
        body = without_comments(match.group(1))
        if _NAME_LETTER.search(body):
            return None
        try:
            numbers = parse_numbers(body)
        except NotNumbersError as error:
            line = self.line(self._at)
            raise InputError(f"{self._file}: in the list that begins in line {line}: {error}") from None
        self._at = match.end()
        return numbers

    def numbers(self) -> NDArray[np.float64]:
        """The numbers that follow one another here."""
        found = []
        while (token := self.peek()).kind is TokenKind.NUMBER:
            found.append(parse_number(token.text))
            self._ahead = None
        return np.array(found, dtype=np.float64)

    def _read(self) -> Token:
        self._count += 1
        if self._count > _MAX_TOKENS:
            raise InputError(f"{self._file} has more than {_MAX_TOKENS} words outside lists of numbers")
        match = _TOKEN.match(self._text, self._at)
        if match is None or match.lastgroup is None or match.lastgroup == "open":
            at = self._at if match is None else match.end() - 1
            raise InputError(f"{self._file}: line {self.line(at)}: the text that begins here never ends")
        group = match.lastgroup
        text, start = match.group(group), match.start(group)
        self._at = match.end()
        if group == "text":
            return Token(TokenKind.TEXT, unescaped(text[1:-1]), start)
        if group == "word":
            return Token(TokenKind.NUMBER if text[0] in _NUMERIC and _is_number(text) else TokenKind.WORD, text, start)
        return Token(TokenKind.SIGN if group == "sign" else TokenKind.END, text, start)


def _is_number(text: str) -> bool:
    try:
        parse_number(text)
    except NotNumbersError:
        return False
    return True
