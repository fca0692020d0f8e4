"""What a user says about a motion file, where it is not to be recognised."""

from dataclasses import dataclass

from elbowroom.errors import InputError

# Metres per unit. The CMU database counts in 0.45ths of an inch (mocap.cs.cmu.edu, "Frequently Asked Questions").
UNITS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048, "cmu": 0.0254 / 0.45}
AXES = ("x", "y", "z", "-x", "-y", "-z")
_FPS = (1.0, 1000.0)


@dataclass(frozen=True)
class Told:
    """Unit by name or in metres, the axis that points up, frames a second; None is recognised. Raises `InputError`."""

    unit: str | None = None  # of lengths: a name such as "cm", or metres as a number
    up: str | None = None  # the axis that points up
    fps: float | None = None  # frames a second

    def __post_init__(self) -> None:
        if self.up is not None and self.up.lower() not in AXES:
            raise InputError(f"up: {self.up[:20]!r} is no axis; allowed are {', '.join(AXES)}")
        if self.fps is not None and not _FPS[0] <= self.fps <= _FPS[1]:
            raise InputError(f"fps: {self.fps} is not between {_FPS[0]:g} and {_FPS[1]:g} frames a second")
        if self.unit is not None:
            self.metres(self.unit)

    @staticmethod
    def metres(unit: str) -> float:
        """Metres of a unit: a name of `UNITS`, or a number. Raises `InputError`."""
        if unit.lower() in UNITS:
            return UNITS[unit.lower()]
        try:
            value = float(unit)
        except ValueError:
            value = 0.0
        if not 1e-5 <= value <= 1e5:
            raise InputError(f"unit: {unit[:20]!r} is neither one of {', '.join(UNITS)} nor metres as a number")
        return value
