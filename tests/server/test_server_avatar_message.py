"""What the page is told about an avatar."""

from pathlib import Path

from avatar_builder import Recipe, build
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.server.sessions.reports import avatar_message
from elbowroom.server.stores.avatar_store import StoredAvatar


def stored(humanoid: Humanoid) -> StoredAvatar:
    return StoredAvatar("it", humanoid, Path("it.glb") if humanoid.glb else None)


def test_what_has_no_mesh_of_a_body_is_drawn_as_capsules() -> None:
    assert not avatar_message(stored(Humanoid.default()), 1).draw_capsules
    token = avatar_message(stored(load_humanoid_bytes(build(Recipe(mesh=False)), "token.glb")), 1)
    assert token.draw_capsules
    assert token.url is not None
    plain = avatar_message(stored(proportional_humanoid(1.7)), 1)
    assert plain.draw_capsules
    assert plain.url is None


def test_facts_are_permissions_and_notes() -> None:
    kept = load_humanoid_bytes(build(Recipe(vrm="1", mesh=False)), "kept.vrm")
    facts = avatar_message(stored(kept), 1).facts
    assert "modification: prohibited" in facts
    assert set(kept.meta.notes) <= set(facts)
    assert len(facts) <= 20
