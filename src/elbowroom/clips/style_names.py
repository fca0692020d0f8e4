"""The names of the stock styles of walking, and how a user names one, or so much of it."""

from elbowroom.errors import InputError

PLAIN_NAME = "plain"
STYLE_NAMES = (PLAIN_NAME, "relaxed", "brisk", "careful", "old", "child")  # `style` has what they are


def check_style_name(name: str) -> None:
    """Raises `InputError` if no stock style has this name."""
    if name not in STYLE_NAMES:
        raise InputError(f"style {name[:40]!r} is none of {', '.join(STYLE_NAMES)}")


def name_and_share(text: str) -> tuple[str, float | None]:
    """What a user means by NAME, or by NAME:SHARE, as `old:0.5`, with a share from 0 to 1; raises `InputError`."""
    name, colon, told = text.partition(":")
    check_style_name(name)
    if not colon:
        return name, None
    try:
        share = float(told)
    except ValueError:
        raise InputError(f"style {text[:40]!r} is not as old or old:0.5") from None
    if not 0.0 <= share <= 1.0:
        raise InputError(f"style {text[:40]!r}: {share:g} is not between 0 and 1")
    return name, share
