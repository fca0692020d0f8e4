"""Which nodes of an arm its own body rules out, against every posture held against every part, one after the other."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.clips.stock_clips import stock_clips
from elbowroom.body.dof import ARMS, LOCAL, SEARCH_ORDER, DofGroup, clamp, columns_of, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, group_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.exact.lattice.extra_nodes import extra_nodes
from elbowroom.planning.exact.lattice.lattice import EXTRA
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures, postures_of
from elbowroom.planning.exact.sweep.own_body import OwnBody
from elbowroom.planning.exact.sweep.own_body_nodes import (
    SPARE,
    OwnBodyNodes,
    OwnBodyTask,
    own_body_costs,
    touches_body,
)
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.limb import limb_of
from elbowroom.planning.model.self_contact import axis_distance
from elbowroom.planning.model.self_pairs import EXEMPT, seen_from_chest, self_clearances, self_pairs, with_waist

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

MODEL = body_model(proportional_humanoid(1.72))
BODY = OwnBody(MODEL, natural_walk())
ROWS, UNSURE = 5, 1e-4  # metres about the limit in which single precision may decide either way


def drawn(rng: np.random.Generator, group: DofGroup, count: int, share: float) -> Floats:
    low, high = limits(group).T
    return clamp(group, rng.uniform(share * low, share * high, (count, group.size)))


def some_postures(side: int) -> Postures:
    group = ARMS[side]
    return postures_of(limb_of(MODEL, group), drawn(np.random.default_rng(side), group, 40, 0.7), 0.5)


POSTURES = [some_postures(side) for side in range(2)]


def gaps_of(side: int, arms: Floats, uppers: Floats, state: Floats) -> Floats:
    """How far beyond what is allowed arm `side` is at `arms` (V, d) from the body, and the right arm from the left."""
    group = ARMS[side]
    capsules, allowed = BODY.pairs.beside(group, group.clear_of)
    axes = seen_from_chest(MODEL, uppers[None], state[None])[capsules, :, 0]
    segments = group_capsules(MODEL, group, arms).astype(np.float64)
    return np.array(
        [
            min(
                axis_distance(segments[c, :, v].copy(), axes[k].astype(np.float64)) - allowed[c, k]
                for c, k in np.argwhere(allowed > EXEMPT)
            )
            for v in range(len(arms))
        ]
    )


class Case:
    """An arm's nodes along a path on which the groups before it are anywhere."""

    def __init__(self, side: int, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.side, self.postures = side, POSTURES[side]
        self.group = group = ARMS[side]
        self.before = np.zeros(LOCAL, np.bool_)
        self.uppers = np.zeros((ROWS, LOCAL))
        for one in SEARCH_ORDER[: SEARCH_ORDER.index(group)]:
            self.uppers[:, columns_of(one)], self.before[columns_of(one)] = drawn(rng, one, ROWS, 0.5), True
        self.states = rng.uniform(-1.0, 1.0, (ROWS, 7)) * [9.0, 9.0, 3.0, 1.2, 0.2, 0.5, 1.0]
        self.natural, self.start = rng.uniform(size=ROWS) < 0.4, drawn(rng, group, 1, 0.7)[0]
        self.walk = np.where(self.natural[:, None], self.uppers, self.uppers + 0.1 * self.before)
        self.mine = mine = drawn(rng, group, ROWS, 0.7)
        self.as_walked = np.random.default_rng([seed, 1]).uniform(size=ROWS) < 0.6
        self.usual = np.where(self.as_walked[:, None], mine, mine + 0.1)
        self.previous = np.where(rng.uniform(size=(ROWS, 1)) < 0.5, mine, drawn(rng, group, ROWS, 0.7))
        self.settled = seed % 3 > 0
        known, step = self.postures, self.postures.step
        self.own, self.needed, _ = extra_nodes(
            known.configurations, known.columns, step, mine, self.previous, self.start, self.settled
        )

    def nodes(self) -> OwnBodyNodes:
        """Its arm among the body, nothing looked at yet."""
        return BODY.own_body_nodes(self.group, self.postures, BODY.resting(self.group, self.postures))

    def costs(self, nodes: OwnBodyNodes | None = None) -> Floats:
        liked = self.mine, self.previous, self.start, self.settled
        task = OwnBodyTask(*liked, self.usual, self.walk, self.uppers, self.states)
        return own_body_costs(nodes or self.nodes(), task).astype(np.float64)

    def twin(self) -> tuple[Bools, Bools]:
        """Which nodes are ruled out (ROWS, W + OWN), and of which that is sure."""
        known = self.postures.configurations
        width = len(self.postures.lanes) * BLOCK
        out, sure = np.zeros((ROWS, width + EXTRA), np.bool_), np.ones((ROWS, width + EXTRA), np.bool_)
        out[:, :width] = BODY.resting(self.group, self.postures)
        filled = np.minimum(np.arange(width), len(known) - 1)
        for t in range(ROWS):
            usual = self.natural[t] and self.as_walked[t]
            if usual and not self.needed[t, 1:].any():
                continue
            gaps = gaps_of(self.side, np.concatenate([known, self.own[t]]), self.uppers[t], self.states[t])
            nodes = np.concatenate([gaps[: len(known)][filled], gaps[len(known) :]]) - SPARE
            looked = np.ones(width + EXTRA, np.bool_)
            if self.natural[t]:
                looked[: width + usual] = False
            out[t] |= looked & (nodes < 0.0)
            sure[t] = ~looked | (np.abs(nodes) > UNSURE)
        return out, sure


@pytest.mark.parametrize("side", [0, 1])
def test_ruled_out_is_what_touches_and_nothing_else(side: int) -> None:
    counts = np.zeros(2, np.int64)
    for seed in range(12):
        case = Case(side, seed)
        found, (expected, sure) = np.isinf(case.costs()), case.twin()
        assert np.array_equal(found[sure], expected[sure])
        assert sure.mean() > 0.99
        counts += [expected.sum(), (~expected).sum()]
    assert counts.min() > 50


def test_what_was_looked_at_is_known_again_among_new_surroundings() -> None:
    case, other = Case(1, 7), Case(1, 8)
    nodes = case.nodes()
    first = case.costs(nodes)
    other.uppers[2], other.states[2], other.states[2, :3] = case.uppers[2], case.states[2], 0.0  # wherever it stands
    mixed = other.costs(nodes)
    assert np.array_equal(mixed, other.costs())
    assert np.array_equal(case.costs(nodes), first)
    assert not np.array_equal(mixed, first)


def test_no_ball_hides_a_posture() -> None:
    """Blocks are passed over by their balls: what is found is what single postures show."""
    rng, postures = np.random.default_rng(11), POSTURES[0]
    axes = rng.uniform(-0.6, 0.6, (12, 6)).astype(np.float32)
    allowed = rng.uniform(-0.05, 0.15, (postures.segments.shape[0], 12)).astype(np.float32)
    found = touches_body(postures.lanes, postures.balls, axes, allowed, SPARE)
    for v in range(len(postures.configurations)):
        gaps = [
            axis_distance(postures.segments[c, :, v].astype(np.float64), axes[p].astype(np.float64))
            - (allowed[c, p] + SPARE)
            for c, p in np.ndindex(allowed.shape)
            if allowed[c, p] + SPARE > 0.0
        ]
        assert found[v] == (min(gaps) < 0.0) or abs(min(gaps)) < UNSURE
    assert 0.1 < found.mean() < 0.9


def test_what_the_clips_bend_to_is_walked_in_at_full_pace() -> None:
    """Belly and thighs keep apart at every moment of a stride: else who comes in some of them finds no way on."""
    states = np.zeros((16, ROOT_STATE))
    states[:, 3], states[:, 6] = 1.1, np.arange(16) / 16
    waists = np.concatenate([clip.sample(np.linspace(0.0, clip.duration, 6)) for clip in stock_clips(DofGroup.WAIST)])
    for model in (body_model(Humanoid.default()), MODEL):
        pairs = self_pairs(model, natural_walk())
        uppers, roots = np.repeat(with_waist(waists), 16, axis=0), np.tile(states, (len(waists), 1))
        gaps = self_clearances(model, pairs, roots, uppers)[SEARCH_ORDER.index(DofGroup.WAIST)]
        assert gaps.min() > 1e-3  # what is asked of a motion far ahead
