"""Where users were, by the keys of their pages: who comes back after a broken line, or a dead server, goes on there."""

import math
import pickle
from dataclasses import dataclass

from elbowroom.body.root import RootState
from elbowroom.server.sessions.wanted import Wanted
from elbowroom.server.stores.shelf import Shelf

NOTED_EVERY = 0.5  # seconds
_PLACES = 24  # that are remembered: where one stood with a turned shoulder there may be no room to stand anew
_APART = 0.05  # metres between them


@dataclass(frozen=True)
class Whereabouts:
    """What a user was shown, and where."""

    wanted: Wanted
    places: tuple[RootState, ...] = ()  # the newest first

    def after(self, wanted: Wanted, place: RootState | None) -> "Whereabouts":
        """The same a moment later; None: there are no places, a clip is shown."""
        before = self.places if wanted.scene == self.wanted.scene else ()
        if place is None:
            return Whereabouts(wanted)
        far = tuple(old for old in before if math.hypot(old.x - place.x, old.z - place.z) > _APART)
        return Whereabouts(wanted, (place, *far)[:_PLACES])


def note(shelf: Shelf, key: str, there: Whereabouts) -> None:
    """Remember where the user of a page is."""
    shelf.put(_name(key), pickle.dumps(there))


def recall(shelf: Shelf, key: str) -> Whereabouts | None:
    """Where the user of a page was, if it is remembered."""
    data = shelf.get(_name(key))
    if data is None:
        return None
    there: Whereabouts = pickle.loads(data)
    return there


def forget(shelf: Shelf, key: str) -> None:
    """The user has left and said so."""
    shelf.drop(_name(key))


def _name(key: str) -> str:
    return f"user:{key}"
