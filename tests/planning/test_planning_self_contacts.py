"""What an arm ran into is not tried again on the same path while the body is the same."""

import numpy as np

from elbowroom.body.dof import DofGroup
from elbowroom.planning.exact.group.own_contacts import Contact, rule_out_near

WAIST, ARM = np.array([0.1, 0.0, 0.0]), np.array([0.5, 0.2, 0.0, 1.0])


def test_a_contact_happens_again_while_the_groups_before_are_the_same() -> None:
    contact = Contact(DofGroup.LEFT_ARM, 5, WAIST, ARM)
    assert contact.happens(WAIST + 1e-9)
    assert not contact.happens(WAIST + 0.01)


def test_nodes_near_to_what_touched_are_ruled_out() -> None:
    rng = np.random.default_rng(0)
    known, own = ARM + rng.uniform(-0.15, 0.15, (30, 4)), ARM + rng.uniform(-0.15, 0.15, (10, 4))
    costs = np.zeros(32 + 10, np.float32)
    costs[7] = np.inf
    rule_out_near(costs, known, own, ARM, 0.15)
    expected = np.concatenate([np.linalg.norm(rows - ARM, axis=1) < 0.15 for rows in (known, np.zeros((2, 4)), own)])
    expected[7] = True
    assert np.array_equal(np.isinf(costs), expected)
    assert 5 < expected.sum() < 37
