"""Results that one walker keeps, each under all that it depends on, to the last bit.

What is found again is what would be computed anew, so nothing but time depends on what is there. Whatever stands in the
scene and the model belong to the walker and never change; what moves is part of a root sweep's key.
"""

from collections.abc import Mapping
from functools import cached_property
from typing import NamedTuple

from elbowroom.body.dof import CHILDREN, LOCAL_GROUPS, DofGroup
from elbowroom.by_reference import by_reference
from elbowroom.planning.exact.group.problem import Group
from elbowroom.planning.exact.group.upper_body_model import PostureSet, UpperBodyModel
from elbowroom.planning.exact.memory.known_rises import new_known_rises
from elbowroom.planning.exact.sweep.motion_bounds import (
    KinematicChain,
    LimbSweeps,
    RootSweeps,
    new_limb_sweeps,
    new_root_sweeps,
)
from elbowroom.planning.exact.sweep.node_clearances import NodeClearances, new_node_clearances
from elbowroom.planning.exact.sweep.own_body_nodes import OwnBodyNodes
from elbowroom.planning.exact.sweep.own_motion import OwnMotion, parts_of
from elbowroom.planning.exact.sweep.scratch import ScratchShelf
from elbowroom.planning.model.footing import Underfoot

_CACHED = 5  # times the horizon: as many results of key intervals are remembered
_TABLES = 2  # times the horizon: the same of tables of postures, which are large and seldom asked for again later


@by_reference
class GroupCache(NamedTuple):
    """One group and the results that its searches use and add to."""

    group: Group
    roots: RootSweeps
    waists: LimbSweeps
    chain: KinematicChain


class Searched(NamedTuple):
    """What the searches of one group have from each other."""

    cache: GroupCache
    scratch: ScratchShelf


class TrunkCache:
    """The trunk as one limb, with the waist's postures: made when it is asked for, as few plans need it."""

    def __init__(self, model: UpperBodyModel, waist: PostureSet, cache: GroupCache, horizon: int) -> None:
        self._made_of = model, waist, cache, horizon

    @cached_property
    def searched(self) -> Searched:
        """As a group's."""
        model, waist, cache, horizon = self._made_of
        group = model.trunk_set(waist)
        made = _group(group, _new_tables(group, horizon), _new_sweeps(horizon, DofGroup.WAIST))
        return Searched(cache._replace(group=made), group.scratch)


class PlanCaches(NamedTuple):
    """All results, of plans over at most `horizon` key intervals."""

    groups: Mapping[DofGroup, Searched]
    trunk: TrunkCache  # the waist with all that follows it
    own_nodes: Mapping[DofGroup, OwnBodyNodes]  # of the groups that hang on the waist
    own_motion: OwnMotion
    own_trunk: OwnMotion  # of the waist's parts alone
    horizon: int

    @property
    def roots(self) -> RootSweeps:
        """The sweeps of the root."""
        return self.groups[DofGroup.WAIST].cache.roots

    @property
    def span(self) -> float:
        """No point of the upper body gets farther from the root's axis, metres."""
        return self.groups[DofGroup.WAIST].cache.chain.span

    def group(self, group: DofGroup) -> Group:
        """A group with its results."""
        return self.groups[group].cache.group


def new_caches(
    model: UpperBodyModel, sets: Mapping[DofGroup, PostureSet], horizon: int, underfoot: Underfoot
) -> PlanCaches:
    """Nothing computed yet, for these posture sets of a model on some ground."""
    roots = new_root_sweeps(_CACHED * (horizon + 1))
    sweeps = {group: _new_sweeps(horizon, group) for group in LOCAL_GROUPS}
    waists = sweeps[DofGroup.WAIST]
    made = {group: _group(sets[group], _new_tables(sets[group], horizon), sweeps[group]) for group in LOCAL_GROUPS}
    groups = {
        group: Searched(GroupCache(made[group], roots, waists, model.chain), sets[group].scratch)
        for group in LOCAL_GROUPS
    }
    trunk = TrunkCache(model, sets[DofGroup.WAIST], groups[DofGroup.WAIST].cache, horizon)
    own_nodes = {group: _own_nodes(model, group, sets[group]) for group in CHILDREN}
    rises = new_known_rises(underfoot)
    own_motion = OwnMotion(model.own_parts, underfoot, rises=rises)
    own_trunk = OwnMotion(parts_of(model.own_parts, DofGroup.WAIST), underfoot, _CACHED * horizon, rises)
    return PlanCaches(groups, trunk, own_nodes, own_motion, own_trunk, horizon)


def with_set(caches: PlanCaches, model: UpperBodyModel, group: DofGroup, made: PostureSet) -> PlanCaches:
    """The same with another posture set for a group; its sweeps stay, as others' results are known by them."""
    old = caches.groups[group].cache
    cache = old._replace(group=_group(made, _new_tables(made, caches.horizon), old.group.sweeps))
    own_nodes = dict(caches.own_nodes)
    if group in own_nodes:
        own_nodes[group] = _own_nodes(model, group, made)
    trunk = TrunkCache(model, made, cache, caches.horizon) if group is DofGroup.WAIST else caches.trunk
    return caches._replace(
        groups={**caches.groups, group: Searched(cache, made.scratch)}, trunk=trunk, own_nodes=own_nodes
    )


def _group(made: PostureSet, tables: NodeClearances, sweeps: LimbSweeps) -> Group:
    return Group(made.postures, made.levers, made.limits, made.speed, made.acceleration, tables, sweeps)


def _new_tables(made: PostureSet, horizon: int) -> NodeClearances:
    return new_node_clearances(_TABLES * (horizon + 1), len(made.limits), made.postures.moves.shape[1])


def _new_sweeps(horizon: int, group: DofGroup) -> LimbSweeps:
    return new_limb_sweeps(_CACHED * (horizon + 1), group.size, carries=group is DofGroup.WAIST)


def _own_nodes(model: UpperBodyModel, group: DofGroup, made: PostureSet) -> OwnBodyNodes:
    return model.own_body.own_body_nodes(group, made.postures, made.resting)
