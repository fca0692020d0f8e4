"""What who stands was offered is offered again in the plans to come: nothing is looked for twice in the same place."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from elbowroom.planning.command import Command
from elbowroom.planning.root.memory import RootMemory
from elbowroom.planning.root.plan import Pause, RootPlan
from elbowroom.planning.root.query import Asked
from elbowroom.planning.stillness import UNMOVED

_COMMANDS = 8  # that are remembered from one place


class Offer(NamedTuple):
    """A path, and what is remembered if it is taken."""

    plan: RootPlan
    memory: RootMemory

    def later(self, time: float, *, anew: bool = False) -> "Offer":
        """The same at another time, for which nothing was searched, or all of it `anew`."""
        path, out = replace(self.plan.path, start_time=time), self.memory.way_out
        passed = time - self.plan.path.start_time
        if out is not None:
            out = out._replace(path=replace(out.path, start_time=out.path.start_time + passed))
        plan = self.plan._replace(path=path) if anew else self.plan.going_on(path)
        return Offer(plan, self.memory._replace(way_out=out))


class _Offers(NamedTuple):
    """Those that were made so far, and the making of more."""

    made: list[Offer]
    more: Iterator[Offer | Pause]


class OffersFromHere:
    """The offers to who stands, command for command, as far as they were asked for; forgotten when it has moved."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, Command, int, float], _Offers] = {}
        self._here: tuple[float, ...] = ()

    def again(self, kind: str, asked: Asked, make: Callable[[], Iterator[Offer | Pause]]) -> Iterator[Offer | Pause]:
        """The offers of a `kind` to who stands and asks; those that nobody has asked for yet are made."""
        here = tuple(asked.start)
        if not self._here or max(abs(a - b) for a, b in zip(here, self._here, strict=True)) > UNMOVED:
            self._known.clear()
            self._here = here
        name = kind, asked.command, asked.horizon, asked.interval
        if name not in self._known:
            if len(self._known) >= _COMMANDS:
                self._known.clear()
            self._known[name] = _Offers([], make())
        made, more = self._known[name]
        for offer in list(made):
            yield offer.later(asked.start_time)
        for found in more:
            if isinstance(found, Pause):
                yield found
            else:
                made.append(found)
                yield found.later(asked.start_time, anew=True)
