"""What there is in a place for somebody who walks: its floors, how much of each can be walked on, and how it opens."""

from collections.abc import Callable
from dataclasses import dataclass

from elbowroom.world.places.beginning import Beginning, beginning_beside, beginning_on
from elbowroom.world.places.columns import Columns, columns_of
from elbowroom.world.places.floor_area import FloorArea
from elbowroom.world.places.floors import Floor, floor_at, floors_of, ground_floor
from elbowroom.world.places.place import Place

_ENOUGH = 3.0  # m² of a region to begin in; with less one begins beside the place


@dataclass(frozen=True, eq=False)
class Survey:
    """A place looked over."""

    place: Place
    columns: Columns
    floors: tuple[Floor, ...]  # from the lowest
    ground: Floor  # the one that is walked on
    beginning: Beginning
    notes: tuple[str, ...]  # how ground and start were found
    floor: FloorArea | None  # to keep to; None where one begins beside the place


def survey(place: Place, progress: Callable[[str, float], None] = lambda _what, _share: None) -> Survey:
    """Look a place over; raises `InputError` where it is too large."""
    columns = columns_of(place, lambda share: progress("Looking for floors", share))
    floors = floors_of(columns)
    ground, how = _ground(place, columns, floors)
    _, sizes = ground.regions()
    if max(sizes, default=0.0) >= _ENOUGH and (beginning := beginning_on(ground)):
        return Survey(place, columns, floors, ground, beginning, (how,), FloorArea.of(ground))
    note = "nowhere in it is there room enough to begin: the start is beside it, on the ground that goes on all round"
    return Survey(place, columns, floors, ground, beginning_beside(place), (how, note), None)


def _ground(place: Place, columns: Columns, floors: tuple[Floor, ...]) -> tuple[Floor, str]:
    told, found = place.options.ground, ground_floor(floors)
    if told is not None:
        return floor_at(columns, told), f"the ground is at {told:.2f} m, as told"
    if found is not None:
        why = "the lowest floor with room to walk" if len(floors) > 1 else "the floor that was found"
        return found, f"the ground is at {found.height:.2f} m, {why} (--ground tells otherwise)"
    least, most = place.bounds
    height = 0.0 if least[1] <= 0.0 <= most[1] else float(least[1])
    return floor_at(
        columns, height
    ), f"no floor to walk on was found in it: the ground is at {height:.2f} m (--ground tells otherwise)"
