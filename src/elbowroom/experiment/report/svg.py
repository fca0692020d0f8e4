"""Small pieces of SVG as text."""

from collections.abc import Iterable
from html import escape


def tag(name: str, *children: str, **attributes: object) -> str:
    """An element. `class_` stands for class, other underscores for hyphens; an attribute that is None is left out."""
    given = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items() if value is not None}
    text = "".join(f' {key}="{escape(_plain(value))}"' for key, value in given.items())
    inside = "".join(children)
    return f"<{name}{text}>{inside}</{name}>" if inside else f"<{name}{text}/>"


def label(text: str, x: float, y: float, **attributes: object) -> str:
    """Text at a place."""
    return tag("text", escape(text), x=x, y=y, **attributes)


def title(text: str) -> str:
    """What is shown when the pointer rests on the parent, and read to who cannot see it."""
    return tag("title", escape(text))


def points(places: Iterable[tuple[float, float]]) -> str:
    """The value of a `points` attribute."""
    return " ".join(f"{_plain(x)},{_plain(y)}" for x, y in places)


def _plain(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
