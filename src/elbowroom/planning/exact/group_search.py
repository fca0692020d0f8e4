"""The way of one group along a root path: cheapest through the lattice, then checked as it will be shown.

A way that touches between its key frames is banned there, with the steps near it; where that happens, all steps of that
key interval are looked at in one batch, and the next cheapest way is taken. So steps are swept only where the search is
blocked, and every candidate is swept as a whole.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.lattice import Ban, Lattice, cheapest_way, new_work
from elbowroom.planning.exact.postures import Postures
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.shown import Moments, shown_motion
from elbowroom.planning.exact.slices import closed_steps, motion_clearances, swept_clearances
from elbowroom.planning.limb import pose
from elbowroom.planning.self_contact import clear_of_trunk

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

OWN = 4  # postures of a key time alone: goal, what the last plan had, the start, on the way from start to goal
_GOAL, KEPT, _HOLD, _BACK = range(OWN)
_STRIDE = 3  # every third shown moment is looked at around a key time
_BAN_RADIUS = 0.1  # radians: steps so near to one that touches are banned with it
_LIKE = 0.15  # radians: postures so near to each other are taken to touch in the same steps
_BACK_STEP = 0.8  # of the longest step


class GroupTask(NamedTuple):
    """What one group has to do."""

    postures: Postures
    tables: Floats32  # (M, B, 15) boxes in the limb's frame at the moments
    goals: Floats  # (n+1, d)
    kept: Floats  # (n+1, d) what the last plan had
    start: Floats  # (d,) at the path's start
    upper: Floats  # (d,) what is shown at this moment
    velocity: Floats  # (d,)


class GroupWay(NamedTuple):
    """What was found."""

    reached: int  # n if there is a way, else the depth that none got beyond
    keys: Floats  # (reached+1, d)
    shown: Floats  # (M, d) the motion shown, or (0, d)
    free: NDArray[np.bool_]  # (n+1, V) the postures that are free around each key time
    checks: int
    nodes: int


def search_group(task: GroupTask, moments: Moments, settings: ExactSettings, extra: Floats | None = None) -> GroupWay:
    """The cheapest way whose motion is free as shown; `extra` (n+1, V+OWN) is added to the nodes' prices.

    Margins are smaller where the start has less clearance, so that who stands close by can go.
    """
    limb, least = task.postures.limb, max(0.5 * _start_clearance(task, moments), 0.0)
    shares = np.minimum(settings.soon_share + (1.0 - settings.soon_share) * moments.times / settings.soon, 1.0)
    margins = np.minimum(settings.margin * shares[moments.lead :: moments.samples], least)
    skins = np.minimum(settings.skin * shares, least)
    own = _own_postures(task)
    capsules = _own_segments(task, own)
    clear, checks = swept_clearances(
        task.postures.segments, capsules, limb.radii, task.tables[moments.lead :], moments.samples, _STRIDE,
        task.postures.reach,
    )  # fmt: skip
    price = _prices(task, own, capsules, clear, margins, settings)
    free = np.isfinite(price[:, : len(task.postures.configurations)])
    if extra is not None:
        price = price + extra
    closed = np.zeros((len(own) - 1, len(task.postures.targets)), np.bool_)
    known = task.postures
    likes = np.full((len(own), OWN), -1, np.int32)
    lattice = Lattice(
        known.configurations, known.first, known.targets, own, task.goals, task.start, price, closed, likes,
        len(known.configurations) + KEPT, known.step, settings.step_weight,
    )  # fmt: skip
    horizon, nodes = len(own) - 1, 0
    ban = Ban(np.empty(0, np.int32), np.empty((0, 2 * len(task.start))), _BAN_RADIUS)
    looked_at = np.zeros(horizon, np.bool_)
    work = new_work(lattice)
    deepest, way = 0, cheapest_way(lattice, ban, work, 0)
    for _ in range(settings.rounds):
        nodes += way.nodes
        if way.reached < horizon:
            return GroupWay(way.reached, way.path, way.path[:0], free, checks, nodes)
        shown = shown_motion(moments, task.upper, task.velocity, way.path)
        found = motion_clearances(pose(limb, shown), limb.radii, task.tables, task.postures.reach)
        checks += len(found)
        touching = np.flatnonzero(found < skins)
        if not len(touching):
            return GroupWay(horizon, way.path, shown, free, checks, nodes)
        depths = np.unique(np.maximum(touching - moments.lead - 1, 0) // moments.samples)
        deepest = max(deepest, int(depths[0]))
        ban = _banned_too(ban, way.path, depths)
        if not looked_at.any():
            likes[:] = _likes(task, own)
        for depth in depths[~looked_at[depths]]:
            at = moments.lead + int(depth) * moments.samples
            tables = task.tables[at : at + moments.samples + 1]
            sources, targets = _ends(lattice, int(depth))
            checks += closed_steps(known, tables, skins[at], sources, targets, closed[depth])
            looked_at[depth] = True
        way = cheapest_way(lattice, ban, work, int(depths[0]))
    return GroupWay(min(deepest, horizon - 1), way.path[: deepest + 1], way.path[:0], free, checks, nodes)


def _ends(lattice: Lattice, depth: int) -> tuple[Bools, Bools]:
    """The known postures (V,) from which, and to which, steps at a depth may go, or steps of postures like them."""
    size = len(lattice.postures)
    sources, targets = np.zeros(size, np.bool_), np.zeros(size, np.bool_)
    for ends, row in ((sources, depth), (targets, depth + 1)):
        free = np.isfinite(lattice.price[row])
        ends[:] = free[:size] & (row > 0)
        like = lattice.like[row][free[size:]] if row > 0 else lattice.like[0]
        ends[like[like >= 0]] = True
    return sources, targets


def _likes(task: GroupTask, own: Floats) -> Ints:
    """The known posture most like each of a key time's own (n+1, E), or -1 where none is near; row 0 for the start."""
    postures = own.copy()
    postures[0] = task.start
    away = np.linalg.norm(postures[..., None, :] - task.postures.configurations, axis=-1)
    nearest = np.argmin(away, axis=-1)
    return np.where(away.min(axis=-1) < _LIKE, nearest, -1).astype(np.int32)


def _start_clearance(task: GroupTask, moments: Moments) -> float:
    limb = task.postures.limb
    posture = pose(limb, np.stack([task.start, task.upper]))
    at = [moments.lead, 0]
    return float(motion_clearances(posture, limb.radii, task.tables[at], task.postures.reach).min())


def _own_postures(task: GroupTask) -> Floats:
    count, (size,) = len(task.goals), task.start.shape
    own = np.empty((count, OWN, size))
    way = task.goals - task.start
    length = np.maximum(np.linalg.norm(way, axis=1), 1e-9)
    part = np.minimum(_BACK_STEP * task.postures.step * np.arange(count) / length, 1.0)
    own[:, _GOAL], own[:, KEPT], own[:, _HOLD] = task.goals, task.kept, task.start
    own[:, _BACK] = task.start + part[:, None] * way
    return own


def _own_segments(task: GroupTask, own: Floats) -> Floats32:
    depths, extra, size = own.shape
    segments = pose(task.postures.limb, own.reshape(-1, size))
    return np.ascontiguousarray(segments.reshape(*segments.shape[:2], depths, extra).transpose(2, 0, 1, 3))


def _prices(
    task: GroupTask, own: Floats, capsules: Floats32, clear: Floats32, margins: Floats, settings: ExactSettings
) -> Floats:
    """Squared distance from the goal, and the lack of comfort; infinite where a posture is not free."""
    known = np.broadcast_to(task.postures.configurations, (len(own), *task.postures.configurations.shape))
    away = np.concatenate([known, own], axis=1) - task.goals[:, None]
    lack = np.maximum(settings.comfort - clear.astype(np.float64), 0.0)
    price = np.einsum("tvi,tvi->tv", away, away) + settings.near_weight * lack * lack
    first = len(task.postures.configurations)
    price[:, first + KEPT] -= settings.keeping
    price[clear < margins[:, None]] = np.inf
    limb = task.postures.limb
    folded = ~clear_of_trunk(
        np.ascontiguousarray(capsules[:, :, :, _BACK].transpose(1, 2, 0)), limb.trunk, limb.allowed
    )
    price[folded, first + _BACK] = np.inf
    prices: Floats = price
    return prices


def _banned_too(ban: Ban, path: Floats, depths: NDArray[np.int64]) -> Ban:
    steps = np.concatenate([path[depths], path[depths + 1]], axis=1)
    return Ban(np.concatenate([ban.depths, depths.astype(np.int32)]), np.concatenate([ban.steps, steps]), ban.radius)
