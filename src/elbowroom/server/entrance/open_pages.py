"""The sessions of pages that are open: by the page's key, and by the tab that it is shown in, as copies share a key."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple

from elbowroom.server.entrance.page_key import page_key
from elbowroom.server.sessions.session import Session

_SILENT = 2.5  # seconds: a page that is there is heard every second


class Tab(NamedTuple):
    """A page as it is open once; a copy of it has the same key."""

    key: str
    opening: str  # drawn by the page each time that it is loaded

    @classmethod
    def of(cls, query: Mapping[str, str]) -> "Tab":
        """The tab in the address of a request (`?key=`, `?opening=`); empty where there is none."""
        return cls(page_key(query), page_key({"key": query.get("opening", "")}))


class OpenPages:
    """Which session belongs to which tab."""

    def __init__(self) -> None:
        self._sessions: dict[Tab, Session] = {}

    def is_heard(self, key: str) -> bool:
        """Whether a page with this key is there, maybe a copy."""
        return any(tab.key == key and session.silence <= _SILENT for tab, session in self._sessions.items())

    def session(self, tab: Tab) -> Session | None:
        """What is shown in a tab; None where it has no key, or nothing is shown."""
        return self._sessions.get(tab) if tab.key else None

    @contextmanager
    def showing(self, tab: Tab, session: Session) -> Iterator[None]:
        """A session in its tab, while it lasts."""
        self._sessions[tab] = session
        try:
            yield
        finally:
            if self._sessions.get(tab) is session:
                del self._sessions[tab]
