"""Parameters of which `make test` tries a few, and `make test-long` the others: they are brothers of one kind."""

from collections.abc import Collection, Iterable
from typing import Any

import pytest


def sampled(values: Iterable[Any], few: int | Collection[Any] = 1) -> list[Any]:
    """The values as parameters, the long tests' but for `few` of them: the first so many, or those that are named.

    A tuple is one value for each of several names.
    """
    return [
        value if (number < few if isinstance(few, int) else value in few) else _left_to_long_tests(value)
        for number, value in enumerate(values)
    ]


def _left_to_long_tests(value: Any) -> Any:
    return pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=pytest.mark.long)
