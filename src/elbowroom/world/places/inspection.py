"""A place in words and numbers, for `elbowroom inspect`."""

from dataclasses import dataclass

import numpy as np

from elbowroom.world.places.layers import layers_of, linked_floors
from elbowroom.world.places.passages import Passage, passages_of
from elbowroom.world.places.survey import Survey

_SHOWN = 20  # names of what is left out


@dataclass(frozen=True)
class FloorFacts:
    """One floor."""

    height: float  # metres, in the turned and scaled file
    walkable: float  # m² that a slim body can be on
    regions: tuple[float, ...]  # m² that its middle can be on, of each region that hangs together, the largest first
    passages: tuple[Passage, ...]  # the narrowest between regions
    leads_to: tuple[float, ...]  # heights of other floors that steps, stairs or ramps lead to from here, metres


@dataclass(frozen=True)
class PlaceFacts:
    """What is in the model of a place, and what was made of it."""

    name: str
    format: str
    sha256: str
    size: tuple[float, float, float]  # metres along X, Y and Z
    triangles: int
    parts: int
    unit: float  # metres
    up: str
    told: tuple[str, ...]
    floors: tuple[FloorFacts, ...]
    cell: float  # metres: widths and areas are as exact as this
    ground: float  # height of the floor that is walked on, metres
    start: tuple[float, float, float]  # x, z, heading
    way: float  # metres from there to the finish
    left_out: tuple[str, ...]  # names of nodes that were dropped
    passable: tuple[str, ...]
    notes: tuple[str, ...]


def facts_of(survey: Survey) -> PlaceFacts:
    """The facts of a place that was looked over."""
    place, start = survey.place, survey.beginning
    least, most = place.bounds
    names = place.model.gltf.root.at("nodes").items()
    dropped = sorted(name for node in place.dropped if (name := names[node].at("name").text()))
    x, y, z = np.round(most - least, 3).tolist()
    links = linked_floors(layers_of(survey.columns), [floor.height for floor in survey.floors])
    return PlaceFacts(
        name=place.name,
        format=place.model.kind.value,
        sha256=place.digest,
        size=(x, y, z),
        triangles=place.triangles,
        parts=len(place.parts),
        unit=place.metre,
        up=place.up,
        told=place.told,
        floors=tuple(
            FloorFacts(
                round(floor.height, 3),
                round(floor.area, 2),
                tuple(round(size, 2) for size in sorted(floor.regions()[1], reverse=True)[:8]),
                tuple(passages_of(floor)),
                tuple(round(survey.floors[other].height, 3) for other in links[number]),
            )
            for number, floor in enumerate(survey.floors)
        ),
        cell=survey.columns.cell,
        ground=survey.ground.height,
        start=(round(start.x, 3), round(start.z, 3), round(start.heading, 4)),
        way=round(start.way, 3),
        left_out=tuple(dropped[:_SHOWN]) + ((f"and {len(dropped) - _SHOWN} more",) if len(dropped) > _SHOWN else ()),
        passable=tuple(part.name for part in place.parts if not part.stands)[:_SHOWN],
        notes=(*place.notes, *survey.notes),
    )
