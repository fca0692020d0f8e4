"""The capsules of the stock avatar, fitted beforehand: the fit takes longer than all the rest of loading it.

They lie beside its file, with the digest of the bytes that they belong to, and serve for these alone. Every course and
recording hangs on them, so they stay as long as the avatar does; a test sees to it that they hold its surface, but for
its heels, which stand out by up to 7 mm where an ankle is bent.
`tools/make_stock_avatar` writes both files.
"""

import hashlib
import json
from functools import cache
from typing import Any

import numpy as np

from elbowroom.body.capsules import Capsules
from elbowroom.body.dof import group_of_bone
from elbowroom.body.fitting.fit import Fit
from elbowroom.body.skeleton import Skeleton
from elbowroom.body.stock import stock_fit_path


def stock_fit(avatar: bytes | None, skeleton: Skeleton) -> Fit | None:
    """The fit of an avatar, given the bytes of its file and its skeleton, if this is the stock avatar."""
    stored = _stored()
    if avatar is None or len(avatar) != stored.get("avatar_bytes"):
        return None
    return fit_of(stored, skeleton) if hashlib.sha256(avatar).hexdigest() == stored["avatar_sha256"] else None


@cache
def _stored() -> dict[str, Any]:
    path = stock_fit_path()
    return dict(json.loads(path.read_text("utf-8"))) if path.is_file() else {}


def fit_document(avatar: bytes, skeleton: Skeleton, fit: Fit) -> dict[str, Any]:
    """What is stored of a fit; JSON keeps every bit of its numbers."""
    capsules = fit.capsules
    return {
        "avatar_bytes": len(avatar),
        "avatar_sha256": hashlib.sha256(avatar).hexdigest(),
        "capsules": [
            {
                "name": name,
                "joint": skeleton.names[capsules.joints[i]],
                "start": capsules.starts[i].tolist(),
                "end": capsules.ends[i].tolist(),
                "radius": float(capsules.radii[i]),
            }
            for i, name in enumerate(capsules.names)
        ],
        "bare": list(fit.bare),
    }


def fit_of(document: dict[str, Any], skeleton: Skeleton) -> Fit:
    """The fit that such a document holds, for the skeleton of its avatar."""
    rows: list[dict[str, Any]] = document["capsules"]
    capsules = Capsules(
        names=tuple(row["name"] for row in rows),
        joints=np.array([skeleton.index(row["joint"]) for row in rows], np.int64),
        starts=np.array([row["start"] for row in rows]),
        ends=np.array([row["end"] for row in rows]),
        radii=np.array([row["radius"] for row in rows]),
        groups=tuple(group_of_bone(row["joint"]) for row in rows),
    )
    return Fit(capsules, tuple(document["bare"]), ())
