"""What an arm ran into is known again at the same key time, however that was reckoned, while the body is the same."""

import numpy as np

from elbowroom.planning.exact.memory.own_contacts import OwnContacts, rule_out_near

WAIST, ARM = np.array([0.1, 0.0, 0.0]), np.array([0.5, 0.2, 0.0, 1.0])


def known_at(contacts: OwnContacts, side: int, time: float, waist: np.ndarray = WAIST) -> int:
    return sum(contact.happens(waist) for _, contact in contacts.of(side, np.array([time])))


def test_a_key_time_is_the_same_in_plans_that_begin_elsewhere() -> None:
    contacts = OwnContacts()
    contacts.add(0, 0.15 + 0.15 * 6, WAIST, ARM)
    assert 0.15 + 0.15 * 6 != 0.3 + 0.15 * 5  # as floats
    (found,) = contacts.of(0, 0.3 + 0.15 * np.arange(9.0))
    assert found[0] == 5
    assert np.array_equal(found[1].posture, ARM)
    assert known_at(contacts, 0, 0.3 + 0.15 * 5) == 1
    assert known_at(contacts, 0, 1.2) == 0
    assert known_at(contacts, 1, 1.05) == 0
    assert known_at(contacts, 0, 1.05, WAIST + 0.01) == 0


def test_what_is_past_is_forgotten() -> None:
    contacts = OwnContacts()
    contacts.add(0, 1.05, WAIST, ARM)
    contacts.begin(0.9)
    assert known_at(contacts, 0, 1.05) == 1
    contacts.begin(1.2)
    assert known_at(contacts, 0, 1.05) == 0
    contacts.add(1, 1.5, WAIST, ARM)
    contacts.forget()
    assert known_at(contacts, 1, 1.5) == 0


def test_the_alert_ends() -> None:
    contacts = OwnContacts()
    contacts.add(0, 9.0, WAIST, ARM)
    alerts = []
    for plan in range(20):
        alerts.append(contacts.alert)
        contacts.begin(0.15 * plan)
    assert alerts == sorted(alerts, reverse=True)
    assert alerts[0]
    assert not alerts[-1]


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
