"""Matt surfaces as glTF has them: its own default, for what names no material, is bare metal."""

from typing import Any


def matt(colour: tuple[float, float, float]) -> dict[str, Any]:
    """A material of one linear colour, seen from both sides."""
    surface = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}
    return {"pbrMetallicRoughness": surface, "doubleSided": True}
