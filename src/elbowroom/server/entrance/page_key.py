"""The key of a page: a secret that it draws itself, by which the server knows whose files are whose."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from elbowroom.server.entrance.guard import is_loopback

_KEY = re.compile(r"[0-9a-f]{32,64}")


def page_key(query: Mapping[str, str]) -> str:
    """The key in the address of a request (`?key=`); "" if there is none or it is none."""
    key = query.get("key", "")
    return key if _KEY.fullmatch(key) else ""


class Sender(NamedTuple):
    """Who sends a file."""

    address: str = ""
    key: str = ""  # of its page, "" for a program

    @property
    def shares(self) -> str:
        """The machine whose share of the place its files fill; "" for this one, which may fill it all."""
        return "" if is_loopback(self.address) else self.address
