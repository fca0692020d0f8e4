"""What is kept for all plans with the same key interval."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.group.problem import Group
from elbowroom.planning.exact.lattice.lattice import Work
from elbowroom.planning.exact.memory.cache_index import begin_round
from elbowroom.planning.exact.sweep.motion_bounds import KinematicChain, LimbSweeps, RootSweeps, root_sweeps

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]


class GroupCache(NamedTuple):
    """What the searches of one group look at and write down, whatever they are asked for."""

    group: Group
    roots: RootSweeps
    waists: LimbSweeps
    chain: KinematicChain
    work: Work


class PlanCaches(NamedTuple):
    """All that depends on the interval, with room for so many of them."""

    held: Mapping[DofGroup, GroupCache]
    horizon: int  # the greatest number of key intervals that there is room for

    @staticmethod
    def of(
        groups: Mapping[DofGroup, Group],
        works: Mapping[DofGroup, Work],
        roots: RootSweeps,
        chain: KinematicChain,
        horizon: int,
    ) -> "PlanCaches":
        """The shelves of these groups, one of which is the waist."""
        waists = groups[DofGroup.WAIST].ways
        made = {group: GroupCache(groups[group], roots, waists, chain, works[group]) for group in groups}
        return PlanCaches(made, horizon)

    @property
    def roots(self) -> RootSweeps:
        """The ways of the root."""
        return self.held[DofGroup.WAIST].roots

    @property
    def span(self) -> float:
        """No point of the upper body gets farther from the root's axis, metres."""
        return self.held[DofGroup.WAIST].chain.span

    def group(self, group: DofGroup) -> Group:
        """What is known of a group."""
        return self.held[group].group

    def with_group(self, group: DofGroup, made: Group, scratch: Work) -> "PlanCaches":
        """The same with another set of postures for a group; its ways stay, as others' tables are known by them."""
        old = self.held[group]
        cache = old._replace(group=made._replace(ways=old.group.ways), work=scratch)
        return self._replace(held={**self.held, group: cache})


@exact_kernel
def begin_root_sweeps(cache: GroupCache, states: Floats, interval: float, stamps: Floats) -> Longs:
    """The `root_sweeps` of a new plan: the slots (n,) between key states (n+1, 7), each with its stamp (n,)."""
    begin_round(cache.roots.entries)
    return root_sweeps(cache.roots, cache.chain, states, interval, stamps)
