"""Where poses are sent by the Virtual Motion Capture protocol, and how."""

from dataclasses import dataclass
from enum import Enum

from elbowroom.errors import InputError

PORT = 39539  # of a marionette
LOOPBACK = "127.0.0.1"


class Locomotion(Enum):
    """What carries the way: some receivers ignore the root."""

    ROOT = "root"
    HIPS = "hips"

    @classmethod
    def named(cls, text: str) -> "Locomotion":
        """That of this name; raises `InputError`."""
        if text not in [way.value for way in cls]:
            raise InputError(f"vmc root: {text[:20]!r}, allowed are root and hips")
        return cls(text)


@dataclass(frozen=True)
class VmcSettings:
    """Where to, and how."""

    host: str = LOOPBACK
    port: int = PORT
    locomotion: Locomotion = Locomotion.ROOT
    bundles: bool = True  # some receivers read single messages only

    @classmethod
    def parse(cls, address: str, locomotion: str = "root", *, bundles: bool = True) -> "VmcSettings":
        """From `HOST:PORT`, `HOST` or `PORT`; raises `InputError`."""
        host, colon, port = address.rpartition(":")
        if not colon:
            host, port = ("", address) if address.isdecimal() else (address, str(PORT))
        if not port.isdecimal() or not 0 < int(port) < 65536:
            raise InputError(f"vmc: {address[:60]!r} is no address: HOST:PORT with a port from 1 to 65535")
        return cls(host or LOOPBACK, int(port), Locomotion.named(locomotion), bundles)
