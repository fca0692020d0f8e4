"""The certificate's law: the named boxes close every posture, and without any one of them a posture is open."""

from itertools import product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.planning.exact.certificate.obstacles import SliceContacts, blocking_obstacles


def random_contacts(seed: int) -> SliceContacts:
    rng = np.random.default_rng(seed)
    boxes, w, a, b = (int(n) for n in rng.integers(1, 6, 4))
    density = rng.uniform(0.0, 0.8)
    return SliceContacts(
        rng.random((w, a, b)) < rng.uniform(0.0, 1.0),
        rng.random((boxes, w)) < density,
        rng.random((boxes, w, a)) < density,
        rng.random((boxes, w, b)) < density,
    )


def blocks(contacts: SliceContacts, boxes: list[int]) -> bool:
    """Whether some boxes close every candidate, one triple after the other."""
    for w, left, right in product(*(range(n) for n in contacts.candidates.shape)):
        if not contacts.candidates[w, left, right]:
            continue
        if not any(contacts.waist[b, w] or contacts.left[b, w, left] or contacts.right[b, w, right] for b in boxes):
            return False
    return True


@settings(deadline=None, max_examples=300)
@given(st.integers(0, 100_000))
def test_the_named_boxes_block_and_each_is_needed(seed: int) -> None:
    contacts = random_contacts(seed)
    found, every = blocking_obstacles(contacts), list(range(len(contacts.waist)))
    assert (found is not None) == blocks(contacts, every)
    if found is not None:
        named = [int(b) for b in found]
        assert blocks(contacts, named)
        for box in named:
            assert not blocks(contacts, [other for other in named if other != box])


def test_nothing_is_named_where_nothing_was_possible() -> None:
    contacts = random_contacts(1)
    contacts.candidates[:] = False
    found = blocking_obstacles(contacts)
    assert found is not None
    assert len(found) == 0
