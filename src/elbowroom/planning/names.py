"""The planners' names, where importing the planners themselves would take too long."""

from elbowroom.errors import InputError

FIGURE6 = "figure6"  # the paper's own search
EXACT = "exact"  # dynamic programming, checked as shown
BUILT_IN = (EXACT, FIGURE6)
DEFAULT_PLANNER = EXACT

_names = list(BUILT_IN)


def planner_names() -> tuple[str, ...]:
    """All names, in the order in which they are offered."""
    return tuple(_names)


def check_planner(name: str) -> None:
    """Raises `InputError` if there is no planner of this name."""
    if name not in _names:
        raise InputError(f"planner {str(name)[:40]!r} is unknown; there are {', '.join(_names)}")


def add_planner_name(name: str) -> None:
    """Offer one more name; `planner.register_planner` says who answers to it."""
    if name not in _names:
        _names.append(name)
