"""What a file forbids is not done."""

import pytest

from elbowroom.body.permissions import Permissions, Use, of_vrm_0, of_vrm_1


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
