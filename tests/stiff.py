"""A body that cannot crouch: the others bend, nod and go into the knees below what is no lower than the hips."""

import pytest

from elbowroom.body import dof
from elbowroom.body.clips.stock_clips import stock_clips
from elbowroom.body.dof import LOWERING, DofGroup, limits


def forbid_crouching(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no waist be lowered; the clips, whose postures are, are read before."""
    assert any(clip.configurations[:, 2].any() for clip in stock_clips(DofGroup.WAIST))
    lowered = limits(DofGroup.WAIST)
    lowered[LOWERING - DofGroup.WAIST.at.start] = 0.0
    monkeypatch.setitem(dof._LIMITS, DofGroup.WAIST, lowered)
