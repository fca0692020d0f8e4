"""Runs where `usd-core` is: the world places of a UsdSkel skeleton's joints, and what UsdValidation says.

Call: python usd.py FILE FPS FRAMES NAMES; prints one JSON object.
"""

import json
import sys
from typing import Any

from pxr import Usd, UsdGeom, UsdSkel, UsdValidation


def complaints(stage: Any) -> list[str]:
    """What all validators of USD find wrong."""
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    return [str(error.GetMessage()) for error in UsdValidation.ValidationContext(validators).Validate(stage)]


def places(stage: Any, frames: list[int], names: list[str]) -> list[list[list[float]]]:
    """World places of the joints in metres."""
    cache, root = UsdSkel.Cache(), UsdSkel.Root(stage.GetDefaultPrim())
    cache.Populate(root, Usd.PrimDefaultPredicate)
    (binding,) = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
    query = cache.GetSkelQuery(binding.GetSkeleton())
    order = [str(joint).rpartition("/")[2] for joint in query.GetJointOrder()]
    unit, found = UsdGeom.GetStageMetersPerUnit(stage), []
    for frame in frames:
        matrices = query.ComputeJointSkelTransforms(frame)
        at = [matrices[order.index(name)].ExtractTranslation() for name in names]
        found.append([[unit * place[i] for i in range(3)] for place in at])
    return found


def main() -> None:
    frames, names = json.loads(sys.argv[3]), json.loads(sys.argv[4])
    stage = Usd.Stage.Open(sys.argv[1])
    version = ".".join(str(number) for number in Usd.GetVersion()[1:])
    print(json.dumps({"version": version, "places": places(stage, frames, names), "errors": complaints(stage)}))


main()
