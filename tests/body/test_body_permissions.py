"""What a file forbids is not done."""

import numpy as np
import pytest

from avatar_builder import Recipe, build
from elbowroom.body.loading.avatar_file import load_humanoid, load_humanoid_bytes
from elbowroom.body.loading.permissions import Permissions, Use, of_vrm_0, of_vrm_1
from shared_data import SHARED, needs_shared


@pytest.mark.parametrize(
    ("permissions", "hand_out", "embed"),
    [
        (Permissions(), True, True),  # a plain glTF that says nothing
        (of_vrm_1({}), False, False),  # VRM 1.0: what is not said has the strictest default
        (of_vrm_1({"allowRedistribution": True}), True, False),
        (of_vrm_1({"allowRedistribution": True, "modification": "allowModification"}), True, True),
        (of_vrm_1({"modification": "allowModificationRedistribution"}), False, False),
        (of_vrm_1({"allowRedistribution": "true"}), False, False),
        (of_vrm_0({"licenseName": "Redistribution_Prohibited"}), False, False),
        (of_vrm_0({"licenseName": "CC_BY_ND"}), True, False),
        (of_vrm_0({"licenseName": "CC_BY_NC_SA"}), True, True),
        (of_vrm_0({"licenseName": "CC0"}), True, True),
        (of_vrm_0({"licenseName": "Other"}), True, True),
    ],
)
def test_uses(permissions: Permissions, hand_out: bool, embed: bool) -> None:
    assert permissions.permits(Use.HAND_OUT) is hand_out
    assert permissions.permits(Use.EMBED) is embed
    for use in Use:
        refusal = permissions.refusal(use)
        assert (refusal is None) is permissions.permits(use)
        assert refusal is None or "licence forbids" in refusal


def test_what_is_said_is_shown() -> None:
    old = of_vrm_0({"licenseName": "CC_BY_NC", "allowedUserName": "Everyone", "violentUssageName": "Disallow"})
    assert old.lines()["who may use it"] == "everyone"
    assert old.lines()["commercial use"] == "without profit"
    assert old.lines()["credit"] == "required"
    assert old.lines()["violent acts"] == "forbidden"
    assert Permissions().lines() == {}


@pytest.mark.parametrize("recipe", [Recipe(vrm="1", spin=True), Recipe(vrm="0", heading=np.pi, unit=1.1)])
def test_a_vrm_is_never_changed(recipe: Recipe) -> None:
    data = build(recipe)
    assert load_humanoid_bytes(data, "mine.vrm").glb == data


@pytest.mark.long
@needs_shared
def test_vrms_of_others_are_never_changed() -> None:
    assert SHARED is not None
    for path in sorted(SHARED.glob("avatars/vrm[01]/*.vrm")):
        assert load_humanoid(path).glb == path.read_bytes()
