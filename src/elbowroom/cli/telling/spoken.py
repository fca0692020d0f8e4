"""What commands say, in English or Traditional Chinese, as the environment is set.

`ELBOWROOM_LANG` (`en`, `zh-Hant`) goes before `LC_ALL`, `LC_MESSAGES` and `LANG`. Names of options, JSON, errors and
logs are English in any language: other programs read them, and people look for them.
"""

import os

from elbowroom.cli.telling.chinese import CHINESE

_SET_BY = ("ELBOWROOM_LANG", "LC_ALL", "LC_MESSAGES", "LANG")


def in_chinese() -> bool:
    """Whether commands speak Chinese."""
    wish = next((wish for name in _SET_BY if (wish := os.environ.get(name))), "")
    return wish.lower().startswith("zh")


def said(english: str, *values: object) -> str:
    """A text as the environment is set, with values in place of {0}, {1} …; one that is unknown stays English."""
    words = CHINESE.get(english, english) if in_chinese() else english
    return words.format(*values) if values else words
