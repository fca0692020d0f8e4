"""Postures drawn for a blocked slice: which of them are free there, and worth taking in."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.planning.exact.joint.clearances import Lanes, clearances_under
from elbowroom.planning.exact.joint.step import PathSurroundings
from elbowroom.planning.exact.lattice.drawing import drawn_postures
from elbowroom.planning.exact.lattice.postures import blocks_of
from elbowroom.planning.exact.refine.sampling import RefinementSettings, chosen
from elbowroom.planning.exact.sweep.own_body import OwnBody
from elbowroom.planning.exact.sweep.own_body_nodes import SPARE, touches_body
from elbowroom.planning.model.limb import Limb, pose
from elbowroom.planning.model.self_pairs import carriers_of, with_waist
from elbowroom.world.obstacles.rows import span_of

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_WAISTS = 6  # waists of a blocked slice under which their children are tried


class BlockedSlice(NamedTuple):
    """A slice that a group could not get through."""

    depth: int
    around: PathSurroundings
    goal: Floats  # (d,)
    margin: float  # metres of clearance that a posture needs
    waists: Floats  # (F, d) that are free there, the best first


class Known(NamedTuple):
    """What is known of a group whose postures are refined."""

    group: DofGroup
    limb: Limb
    reach: float  # metres: none of its capsules gets farther from the frame that carries it
    postures: Floats  # (V, d) that it has already


def waists_for(
    body: OwnBody,
    known: Known,
    blocked: BlockedSlice,
    settings: RefinementSettings,
    too_deep: Callable[[int, Floats], Bools],
) -> Floats:
    """Waist postures (k, d) that are free in a blocked slice and unlike those that are known.

    `too_deep` tells which of some (N, d) crouch deeper at a key time than the legs can: on stairs, most that crouch.
    """
    limb = known.limb
    drawn = drawn_postures(known.group, blocked.goal, settings.drawn, settings.near)
    places, turns = blocked.around.places[blocked.depth][None], blocked.around.turns[blocked.depth][None]
    lanes = Lanes(*blocks_of(pose(limb, drawn), limb.radii), known.reach)
    clear, _ = clearances_under(
        lanes, places, turns, span_of(blocked.around.obstacles, blocked.depth), np.ones(1, np.bool_)
    )
    free: Bools = clear[0, : len(drawn)] >= blocked.margin
    free[free] = ~body.folded(drawn[free])
    free[free] = ~too_deep(blocked.depth, drawn[free])
    return _worth(drawn, free, known.postures, blocked.goal, settings)


def children_for(body: OwnBody, known: Known, blocked: BlockedSlice, settings: RefinementSettings) -> Floats:
    """A child's postures (k, d) that are free in a blocked slice under one of its waists, and unlike the known."""
    limb, carriers = known.limb, carriers_of(known.group)
    drawn = drawn_postures(known.group, blocked.goal, settings.drawn, settings.near)
    waists = blocked.waists[:_WAISTS]
    if not len(waists):
        return drawn[:0]
    frames = blocked.around.chests(body.model, blocked.depth, waists)
    lanes = Lanes(*blocks_of(pose(limb, drawn), limb.radii), known.reach)
    obstacles, every = span_of(blocked.around.obstacles, blocked.depth), np.ones(len(waists), np.bool_)
    clear, _ = clearances_under(lanes, *frames, obstacles, every)
    free: Bools = clear[:, : len(drawn)] >= blocked.margin
    if carriers:
        states = np.repeat(blocked.around.states[blocked.depth][None], len(waists), axis=0)
        parts = body.parts(known.group, carriers, body.seen(with_waist(waists), states))
        for row, axes in enumerate(parts.axes):
            free[row] &= ~touches_body(lanes.lanes, lanes.balls, axes, parts.allowed, SPARE)[: len(drawn)]
    under_any: Bools = free.sum(axis=0) > 0
    return _worth(drawn, under_any, known.postures, blocked.goal, settings)


def _worth(drawn: Floats, free: Bools, known: Floats, goal: Floats, settings: RefinementSettings) -> Floats:
    costs = np.where(free, np.sum((drawn - goal) ** 2, axis=1), np.inf)
    taken: Floats = drawn[chosen(drawn, costs, known, settings.apart, settings.taken)]
    return taken
