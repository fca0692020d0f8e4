"""Many numbers at once: the bulk of every X3D and VRML file."""

import re

import numpy as np
from numpy.typing import NDArray

_PIECE = 1 << 20  # characters that are split at once, which bounds the memory that takes
_COMMENT = re.compile(r"#[^\r\n]*")
_STRING = re.compile(r'"((?:[^"\\]|\\.)*+)"', re.DOTALL)
_ESCAPED = re.compile(r"\\(.)", re.DOTALL)
_BLANK = re.compile(r"[\s,]")
_BOOLEANS = {"TRUE": 1.0, "FALSE": 0.0, "true": 1.0, "false": 0.0}


class NotNumbersError(ValueError):
    """A text that should hold numbers holds something else: the message shows it."""


def parse_numbers(text: str) -> NDArray[np.float64]:
    """All numbers (n,) of a text, separated by white space and commas; hexadecimal ones and booleans count too."""
    pieces = [_numbers(piece) for piece in _pieces(text)]
    return pieces[0] if len(pieces) == 1 else np.concatenate([np.zeros(0), *pieces])


def without_comments(text: str) -> str:
    """The text without what follows a `#` up to the end of its line."""
    return _COMMENT.sub(" ", text) if "#" in text else text


def parse_number(word: str) -> float:
    """One number; raises `NotNumbersError`."""
    if word in _BOOLEANS:
        return _BOOLEANS[word]
    try:
        if word[:2].lower() == "0x":
            return float(int(word[:20], 16))
        if "_" in word:
            raise ValueError
        return float(word)
    except ValueError:
        raise NotNumbersError(f"{word[:40]!r} is not a number") from None


def parse_strings(text: str) -> tuple[str, ...]:
    """The texts of an MFString attribute: each in quotes, or one without."""
    found = [unescaped(match.group(1)) for match in _STRING.finditer(text)]
    return tuple(found) if found or not text.strip() else (text.strip(),)


def unescaped(text: str) -> str:
    """A quoted text with its backslashes resolved."""
    return _ESCAPED.sub(r"\1", text) if "\\" in text else text


def _numbers(text: str) -> NDArray[np.float64]:
    words = text.replace(",", " ").split() if "," in text else text.split()
    try:
        if "_" in text:
            raise ValueError
        return np.fromiter(map(float, words), np.float64, len(words))
    except ValueError:
        return np.fromiter(map(parse_number, words), np.float64, len(words))


def _pieces(text: str) -> list[str]:
    """The text cut at blanks into pieces of bounded size."""
    if len(text) <= _PIECE:
        return [text]
    pieces, start = [], 0
    while start < len(text):
        blank = _BLANK.search(text, min(start + _PIECE, len(text)))
        end = blank.start() if blank else len(text)
        pieces.append(text[start:end])
        start = end
    return pieces
