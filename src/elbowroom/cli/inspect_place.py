"""The part of `elbowroom inspect` that looks over models of places."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from elbowroom.cli.telling.output import Bar, print_row
from elbowroom.errors import InputError

if TYPE_CHECKING:
    from elbowroom.world.places.inspection import FloorFacts, PlaceFacts
    from elbowroom.world.places.options import PlaceOptions
    from elbowroom.world.places.survey import Survey

_SHOWN = 5  # regions and passages in the table; --json has more


def look_over(path: Path, options: "PlaceOptions", bar: Bar) -> "tuple[PlaceFacts, Survey]":
    """Read a place and look it over; raises `InputError`."""
    from elbowroom.world.places.inspection import facts_of
    from elbowroom.world.places.reading import read_place
    from elbowroom.world.places.survey import survey

    def progress(what: str, share: float) -> None:
        bar.note(f"{path.name}: {what.lower()} {share:.0%}")

    found = survey(read_place(path, options, progress), progress)
    return facts_of(found), found


def draw_plan(path: Path, survey: "Survey") -> str:
    """Draw the floors from above into a PNG; gives a sentence on it."""
    from PIL import Image

    from elbowroom.experiment.floor_plan import floor_plan

    picture = floor_plan(survey)
    try:
        Image.fromarray(picture).save(path, "PNG", optimize=True)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be written ({error})") from None
    return f"{path}: {survey.place.name} from above, {picture.shape[1]} x {picture.shape[0]} pixels"


def as_json(facts: "PlaceFacts") -> dict[str, Any]:
    """The facts for `--json`."""
    return asdict(facts)


def print_place(facts: "PlaceFacts") -> None:
    """The facts as tables."""
    x, y, z = facts.size
    start_x, start_z, heading = facts.start
    rows = {
        "format": facts.format,
        "size": f"{x:.2f} x {z:.2f} m, {y:.2f} m high",
        "triangles": f"{facts.triangles} in {facts.parts} parts",
        "unit and axis": "; ".join(facts.told),
        "one can begin": f"at {start_x:.2f}, {start_z:.2f}, heading {heading:.2f} rad, {facts.way:.1f} m straight on",
        "left out": ", ".join(facts.left_out) or "nothing",
    }
    print_row(facts.name, rows | ({"passable": ", ".join(facts.passable)} if facts.passable else {}))
    print_row(f"Floors (widths and areas to a cell of {100 * facts.cell:.0f} cm)", _floor_rows(facts))
    for note in facts.notes:
        typer.echo(f"note: {note}")


def _floor_rows(facts: "PlaceFacts") -> dict[str, str]:
    if not facts.floors:
        return {"none": "nowhere is there level floor with 1.8 m above it"}
    return {f"{floor.height:+.2f} m": _about(floor) for floor in facts.floors}


def _about(floor: "FloorFacts") -> str:
    regions = [f"{size:.1f}" for size in floor.regions if size >= 0.5]
    parts = f" in {len(regions)} regions" if len(regions) > 1 else ""
    narrow = ", ".join(f"{p.width:.2f} m at {p.x:.1f}, {p.z:.1f}" for p in floor.passages[:_SHOWN])
    leads = ", ".join(f"{height:+.2f} m" for height in floor.leads_to)
    stairs = f"; steps, stairs or ramps lead to {leads}" if leads else ""
    return f"{floor.walkable:.1f} m² to walk on{parts}; narrowest passages: {narrow or 'none under 1.4 m'}{stairs}"
