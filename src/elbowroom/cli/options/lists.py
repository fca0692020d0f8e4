"""Options that name several: with commas between them, again and again, or both."""

from collections.abc import Callable, Collection, Iterable
from pathlib import Path
from typing import TypeVar

from elbowroom.errors import InputError

Number = TypeVar("Number", int, float)


def names_in(given: Iterable[str], whole: Collection[str] = ()) -> tuple[str, ...]:
    """All that an option names; a file, and one of `whole`, is one name, whatever commas are in it."""
    return tuple(
        name for text in given for name in ((text,) if text in whole or Path(text).is_file() else _parts(text))
    )


def whole_numbers_in(option: str, given: Iterable[str], such_as: str) -> tuple[int, ...]:
    """All whole numbers that an option names; raises `InputError`."""
    return _read(int, f"{option} {{0!r}}: whole numbers with commas between them, such as {such_as}", given)


def numbers_in(option: str, given: Iterable[str], such_as: str) -> tuple[float, ...]:
    """All numbers that an option names; raises `InputError`."""
    return _read(float, f"{option} {{0!r}}: numbers with commas between them, such as {such_as}", given)


def _read(kind: Callable[[str], Number], wrong: str, given: Iterable[str]) -> tuple[Number, ...]:
    numbers: list[Number] = []
    for text in given:
        try:
            numbers += map(kind, text.split(","))
        except ValueError:
            raise InputError(wrong.format(text[:40])) from None
    return tuple(numbers)


def _parts(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",") if part.strip())
