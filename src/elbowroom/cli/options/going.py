"""Places on the command line, and how a walk to one is told."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

from elbowroom.cli.telling.output import print_json, print_row
from elbowroom.cli.telling.spoken import said
from elbowroom.errors import InputError

if TYPE_CHECKING:
    from elbowroom.experiment.tour.leg import Leg
    from elbowroom.planning.navigation.way import Place, Spot

TO_HELP = "Go to this place, metres: X,Z, or X,Y,Z with Y the height of the floor there."


def place_of(text: str, option: str) -> "Place | Spot":
    """The place (x, z) or (x, height, z) that is told as `X,Z` or `X,Y,Z`; raises `InputError`."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise InputError(f"{option}: {text!r} is no place; write X,Z or X,Y,Z in metres, as 1.5,-2")
    return (numbers[0], numbers[1]) if len(numbers) == 2 else (numbers[0], numbers[1], numbers[2])


def report_leg(leg: "Leg", scene: str, record: Path | None, json: bool) -> None:
    """How a walk to a place went, as a table or as JSON."""
    from dataclasses import asdict

    if json:
        print_json({"scene": scene} | asdict(leg) | {"recording": None if record is None else str(record)})
        return
    rows = {
        "arrived": said("yes") if leg.arrived else said("no: {0}", leg.outcome),
        "reason": leg.reason,
        "at": told_place(leg.place),
        "time": f"{leg.seconds:.1f} s",
        "way": said("{0} m, more where it is narrow", f"{leg.way_m:.1f}"),
        "stuck": said("{0} times, {1} s", leg.stuck_times, f"{leg.stuck_s:.1f}"),
        "least clearance": f"{1e3 * leg.least_clearance:.1f} mm",
        "recording": "" if record is None else str(record),
    }
    told = {name: value for name, value in rows.items() if value}
    print_row(said("Scene {0}, to {1}", scene, told_place(leg.target)), told)


def told_place(place: "Place | Spot") -> str:
    """A place in words, in the order in which it is told."""
    return ", ".join(f"{number:.2f}" for number in place)
