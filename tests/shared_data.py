"""Where real third-party avatars, motions and scenes are, if this checkout has them beside it."""

import os
from pathlib import Path

import pytest

_CANDIDATE = Path(os.environ.get("ELBOWROOM_SHARED", Path(__file__).resolve().parents[2] / "shared")) / "data"

SHARED: Path | None = _CANDIDATE if _CANDIDATE.is_dir() else None

needs_shared = pytest.mark.skipif(
    SHARED is None, reason="the collection of real avatars is not beside this checkout (set ELBOWROOM_SHARED)"
)
