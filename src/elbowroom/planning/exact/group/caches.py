"""What is kept for all plans with the same key interval."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.held import Held, hold
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.group.problem import Group
from elbowroom.planning.exact.lattice.lattice import Work
from elbowroom.planning.exact.memory.cache_index import begin_round
from elbowroom.planning.exact.sweep.motion_bounds import Chain, LimbWays, RootWays, root_ways

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]


class Shelf(NamedTuple):
    """What the searches of one group look at and write down, whatever they are asked for."""

    group: Group
    roots: RootWays
    waists: LimbWays
    chain: Chain
    work: Work


class Shelves(NamedTuple):
    """All that depends on the interval, with room for so many of them."""

    held: Mapping[DofGroup, Held[Shelf]]
    horizon: int  # the greatest number of key intervals that there is room for

    @staticmethod
    def of(
        groups: Mapping[DofGroup, Group], works: Mapping[DofGroup, Work], roots: RootWays, chain: Chain, horizon: int
    ) -> "Shelves":
        """The shelves of these groups, one of which is the waist."""
        waists = groups[DofGroup.WAIST].ways
        made = {group: hold(Shelf(groups[group], roots, waists, chain, works[group])) for group in groups}
        return Shelves(made, horizon)

    @property
    def roots(self) -> RootWays:
        """The ways of the root."""
        return self.held[DofGroup.WAIST].value.roots

    @property
    def span(self) -> float:
        """No point of the upper body gets farther from the root's axis, metres."""
        return self.held[DofGroup.WAIST].value.chain.span

    def group(self, group: DofGroup) -> Group:
        """What is known of a group."""
        return self.held[group].value.group

    def with_group(self, group: DofGroup, made: Group, room: Work) -> "Shelves":
        """The same with another set of postures for a group; its ways stay, as others' tables are known by them."""
        old = self.held[group].value
        shelf = old._replace(group=made._replace(ways=old.group.ways), work=room)
        return self._replace(held={**self.held, group: hold(shelf)})


@exact_kernel
def begun_ways(shelf: Held[Shelf], states: Floats, interval: float, stamps: Floats) -> Longs:
    """The `root_ways` of a new plan: the slots (n,) between key states (n+1, 7), each with its stamp (n,)."""
    begin_round(shelf.value.roots.slots)
    return root_ways(shelf.value.roots, shelf.value.chain, states, interval, stamps)
