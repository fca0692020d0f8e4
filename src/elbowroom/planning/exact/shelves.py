"""What is kept for all plans with the same key interval."""

from collections.abc import Mapping
from typing import NamedTuple

from elbowroom.body.dof import DofGroup
from elbowroom.planning.exact.group import Group
from elbowroom.planning.exact.lattice import Work
from elbowroom.planning.exact.ways import Chain, RootWays


class Shelves(NamedTuple):
    """All that depends on the interval, with room for so many of them."""

    groups: Mapping[DofGroup, Group]
    works: Mapping[DofGroup, Work]
    roots: RootWays
    chain: Chain
    horizon: int  # the greatest number of key intervals that there is room for

    def with_group(self, group: DofGroup, made: Group, room: Work) -> "Shelves":
        """The same with another set of postures for a group; its ways stay, as others' tables are known by them."""
        kept = made._replace(ways=self.groups[group].ways)
        return self._replace(groups={**self.groups, group: kept}, works={**self.works, group: room})
