"""What the VRM file says about itself: licence, expressions, gaze and first-person view."""

from make_stock_avatar.vrm import Json

_META: Json = {
    "name": "Elbowroom stock avatar",
    "version": "1.0",
    "authors": ["Elbowroom"],
    "copyrightInformation": "CC0 1.0 Universal: no rights reserved",
    "licenseUrl": "https://vrm.dev/licenses/1.0/",
    "avatarPermission": "everyone",
    "allowExcessivelyViolentUsage": True,
    "allowExcessivelySexualUsage": True,
    "commercialUsage": "corporation",
    "allowPoliticalOrReligiousUsage": True,
    "allowAntisocialOrHateUsage": True,
    "creditNotation": "unnecessary",
    "allowRedistribution": True,
    "modification": "allowModificationRedistribution",
    "otherLicenseUrl": "https://creativecommons.org/publicdomain/zero/1.0/",
}

# preset -> morph targets of the face
_EXPRESSIONS: dict[str, dict[str, float]] = {
    "happy": {"smile": 1.0, "browUp": 0.5, "squint": 1.0},
    "angry": {"browAngry": 1.0, "frown": 0.8},
    "sad": {"browSad": 1.0, "frown": 1.0, "droop": 1.0},
    "relaxed": {"smile": 0.25, "droop": 1.0},
    "surprised": {"browUp": 1.0, "oh": 0.8, "wide": 1.0},
    "aa": {"aa": 1.0},
    "ih": {"ih": 1.0},
    "ou": {"ou": 1.0},
    "ee": {"ee": 1.0},
    "oh": {"oh": 1.0},
    "blink": {"blinkLeft": 1.0, "blinkRight": 1.0},
    "blinkLeft": {"blinkLeft": 1.0},
    "blinkRight": {"blinkRight": 1.0},
    "neutral": {},
}

_HOLDS_LIDS = ("happy", "relaxed", "surprised")  # no blinking over these
_HOLDS_MOUTH = ("happy", "surprised")  # no vowels over these


def vrm_extension(mesh_nodes: dict[str, int], targets: dict[str, tuple[int, int]]) -> Json:
    """The VRMC_vrm extension but for `specVersion` and `humanoid`; `targets` are (node, index) of morph targets."""
    presets = {name: _expression(name, binds, targets) for name, binds in _EXPRESSIONS.items()}
    return {
        "meta": _META,
        "expressions": {"preset": presets},
        "lookAt": {
            "offsetFromHeadBone": [0.0, 0.085, 0.075],
            "type": "bone",
            "rangeMapHorizontalInner": {"inputMaxValue": 90.0, "outputScale": 14.0},
            "rangeMapHorizontalOuter": {"inputMaxValue": 90.0, "outputScale": 14.0},
            "rangeMapVerticalDown": {"inputMaxValue": 90.0, "outputScale": 9.0},
            "rangeMapVerticalUp": {"inputMaxValue": 90.0, "outputScale": 9.0},
        },
        "firstPerson": {"meshAnnotations": [_annotation(name, node) for name, node in mesh_nodes.items()]},
    }


def _expression(name: str, binds: dict[str, float], targets: dict[str, tuple[int, int]]) -> Json:
    document: Json = {
        "isBinary": False,
        "overrideBlink": "block" if name in _HOLDS_LIDS else "none",
        "overrideLookAt": "none",
        "overrideMouth": "block" if name in _HOLDS_MOUTH else "none",
    }
    if binds:
        document["morphTargetBinds"] = [
            {"node": targets[target][0], "index": targets[target][1], "weight": weight}
            for target, weight in binds.items()
        ]
    return document


def _annotation(name: str, node: int) -> Json:
    return {"node": node, "type": "both" if name == "Body" else "thirdPersonOnly"}
