"""What one body, capsules or mesh, is found to do: where it touches, how deep, and where it comes nearest."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Nearness:
    """A body part and an obstacle at one moment."""

    part: str
    obstacle: str
    time: float  # seconds
    clearance: float  # metres; negative: how deep the part is inside


@dataclass(frozen=True)
class Contact:
    """A body part that is inside an obstacle at some poses."""

    part: str
    obstacle: str
    first: float  # seconds, the first touching pose
    last: float  # seconds, the last
    poses: int
    deepest: Nearness


class Ledger:
    """Collects what is found in any order; the only thing in the judge that changes."""

    def __init__(self, tolerance: float) -> None:
        self.tolerance = tolerance  # metres; less deep is no contact
        self.least: Nearness | None = None
        self.touching: set[int] = set()  # poses
        self._contacts: dict[tuple[str, str], Contact] = {}
        self._counted: dict[tuple[str, str], set[int]] = {}

    @property
    def limit(self) -> float:
        """Metres: what is farther than this can change nothing that is kept here."""
        return np.inf if self.least is None else max(self.least.clearance, 0.0)

    @property
    def depth_limit(self) -> float:
        """The same where bounds tell how deep as well: who knows of a touch asks for deeper ones and for contacts."""
        return np.inf if self.least is None else max(self.least.clearance, -self.tolerance)

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """All contacts, the deepest first."""
        return tuple(sorted(self._contacts.values(), key=lambda contact: contact.deepest.clearance))

    def enter(self, pose: int, found: Nearness) -> None:
        """Add what was found at the pose with this number."""
        if self.least is None or found.clearance < self.least.clearance:
            self.least = found
        if found.clearance >= -self.tolerance:
            return
        self.touching.add(pose)
        key = (found.part, found.obstacle)
        poses = self._counted.setdefault(key, set())
        poses.add(pose)
        known = self._contacts.get(key, Contact(*key, found.time, found.time, 0, found))
        self._contacts[key] = replace(
            known,
            first=min(known.first, found.time),
            last=max(known.last, found.time),
            poses=len(poses),
            deepest=min(known.deepest, found, key=lambda nearness: nearness.clearance),
        )
