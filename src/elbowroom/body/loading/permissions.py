"""What an avatar's file allows to be done with it, and which uses of ours ask for that.

Sources: meta of VRM 0.x (`VRM.meta`) and VRM 1.0 (`VRMC_vrm.meta`), github.com/vrm-c/vrm-specification; the names of
the Creative Commons licences tell the rest: ND forbids changes, NC commercial use, BY asks for credit.
"""

from dataclasses import dataclass
from enum import Enum


class Use(Enum):
    """What our program may be asked to do with an avatar beyond showing it to the one who has the file."""

    HAND_OUT = "handing out"  # the file as it is, to somebody else
    EMBED = "putting into another file"  # its mesh in a new file: an animated GLB, a scene


@dataclass(frozen=True)
class Permissions:
    """What the file says; empty texts and None where it is silent, which forbids nothing."""

    avatar: str = ""  # who may act as the avatar
    commercial: str = ""
    credit: str = ""  # "required", "unnecessary"
    redistribution: bool | None = None
    modification: str = ""  # "prohibited", "allowed", "allowed, and handing out the result"
    violent: bool | None = None
    sexual: bool | None = None
    political_or_religious: bool | None = None
    antisocial_or_hate: bool | None = None

    def refusal(self, use: Use) -> str | None:
        """Why a use is forbidden, to be shown as it is; None if it is not."""
        if self.redistribution is False:
            return f"its licence forbids redistribution, so {use.value} is not done"
        if use is Use.EMBED and self.modification == PROHIBITED:
            return f"its licence forbids modification, so {use.value} is not done"
        return None

    def permits(self, use: Use) -> bool:
        """Whether a use is not forbidden. Whoever writes an avatar out asks here first."""
        return self.refusal(use) is None

    def lines(self) -> dict[str, str]:
        """What the file says, by name, ready to be shown."""
        words = {True: "allowed", False: "forbidden"}
        flags = {
            "redistribution": self.redistribution,
            "violent acts": self.violent,
            "sexual acts": self.sexual,
            "political or religious use": self.political_or_religious,
            "antisocial or hateful use": self.antisocial_or_hate,
        }
        texts = {
            "who may use it": self.avatar,
            "commercial use": self.commercial,
            "modification": self.modification,
            "credit": self.credit,
        }
        said = {name: words[flag] for name, flag in flags.items() if flag is not None}
        return {name: text for name, text in texts.items() if text} | said


PROHIBITED = "prohibited"


def of_vrm_1(meta: dict[str, str | bool]) -> Permissions:
    """From the meta of VRM 1.0; what the file leaves out has the specification's default, the strictest."""
    changes = {
        "prohibited": PROHIBITED,
        "allowModification": "allowed",
        "allowModificationRedistribution": "allowed, and handing out the result",
    }
    owners = {
        "onlyAuthor": "only the author",
        "onlySeparatelyLicensedPerson": "only who has a licence of their own",
        "everyone": "everyone",
    }
    sales = {
        "personalNonProfit": "personal, without profit",
        "personalProfit": "personal, with profit",
        "corporation": "by companies too",
    }
    return Permissions(
        avatar=owners.get(str(meta.get("avatarPermission", "onlyAuthor")), ""),
        commercial=sales.get(str(meta.get("commercialUsage", "personalNonProfit")), ""),
        credit=str(meta.get("creditNotation", "required")),
        redistribution=meta.get("allowRedistribution", False) is True,
        modification=changes.get(str(meta.get("modification", "prohibited")), PROHIBITED),
        violent=meta.get("allowExcessivelyViolentUsage", False) is True,
        sexual=meta.get("allowExcessivelySexualUsage", False) is True,
        political_or_religious=meta.get("allowPoliticalOrReligiousUsage", False) is True,
        antisocial_or_hate=meta.get("allowAntisocialOrHateUsage", False) is True,
    )


def of_vrm_0(meta: dict[str, str | bool]) -> Permissions:
    """From the meta of VRM 0.x, whose fields carry the misspelling "Ussage"."""
    licence = str(meta.get("licenseName", ""))
    owners = {
        "OnlyAuthor": "only the author",
        "ExplicitlyLicensedPerson": "only who has a licence of their own",
        "Everyone": "everyone",
    }
    creative = licence.startswith("CC")
    return Permissions(
        avatar=owners.get(str(meta.get("allowedUserName", "")), ""),
        commercial="without profit" if "NC" in licence.split("_") else _allowed(meta, "commercialUssageName"),
        credit="required" if "BY" in licence.split("_") else ("unnecessary" if licence == "CC0" else ""),
        redistribution=False if licence == "Redistribution_Prohibited" else (True if creative else None),
        modification=PROHIBITED if "ND" in licence.split("_") else ("allowed" if creative else ""),
        violent=_flag(meta, "violentUssageName"),
        sexual=_flag(meta, "sexualUssageName"),
    )


def _flag(meta: dict[str, str | bool], key: str) -> bool | None:
    return {"Allow": True, "Disallow": False}.get(str(meta.get(key, "")))


def _allowed(meta: dict[str, str | bool], key: str) -> str:
    return {"Allow": "allowed", "Disallow": "forbidden"}.get(str(meta.get(key, "")), "")
