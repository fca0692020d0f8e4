"""Places on the command line, and how a walk to one is told."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

from elbowroom.cli.output import print_json, print_row
from elbowroom.errors import InputError

if TYPE_CHECKING:
    from elbowroom.experiment.tour.leg import Leg

TO_HELP = "Go to this place on the ground, metres: X,Z, or X,Y,Z as other programs say it."
_ON_THE_GROUND = 0.5  # metres: a place that is higher or lower is on another floor


def place_of(text: str, option: str) -> tuple[float, float]:
    """The place (x, z) that is told as `X,Z` or `X,Y,Z`; raises `InputError`."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise InputError(f"{option}: {text!r} is no place; write X,Z or X,Y,Z in metres, as 1.5,-2")
    if len(numbers) == 3 and abs(numbers[1]) > _ON_THE_GROUND:
        raise InputError(f"{option}: {text} is {numbers[1]:g} m above the ground; only the ground is walked on so far")
    return numbers[0], numbers[-1]


def report_leg(leg: "Leg", scene: str, record: Path | None, json: bool) -> None:
    """How a walk to a place went, as a table or as JSON."""
    from dataclasses import asdict

    if json:
        print_json({"scene": scene} | asdict(leg) | {"recording": None if record is None else str(record)})
        return
    rows = {
        "arrived": "yes" if leg.arrived else f"no: {leg.outcome}",
        "reason": leg.reason,
        "at": f"{leg.place[0]:.2f}, {leg.place[1]:.2f}",
        "time": f"{leg.seconds:.1f} s",
        "way": f"{leg.way_m:.1f} m, more where it is narrow",
        "stuck": f"{leg.stuck_times} times, {leg.stuck_s:.1f} s",
        "least clearance": f"{1e3 * leg.least_clearance:.1f} mm",
        "recording": "" if record is None else str(record),
    }
    told = {name: value for name, value in rows.items() if value}
    print_row(f"Scene {scene}, to {leg.target[0]:.2f}, {leg.target[1]:.2f}", told)
