"""Sends poses by the Virtual Motion Capture protocol: one UDP socket, bundles that fit a packet."""

import contextlib
import socket
from collections.abc import Iterator

from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.server.vmc.protocol import Message, Puppet, VmcMoment, messages
from elbowroom.server.vmc.settings import VmcSettings

_FITS = 1400  # bytes: a bundle of so many goes through any network in one piece
_BUNDLE_HEAD, _LENGTH = 16, 4  # bytes of a bundle, and before each of its messages


class VmcStream:
    """Sends what one holder shows; a context manager. Raises `InputError` for a host that is not found."""

    def __init__(self, settings: VmcSettings) -> None:
        self.settings = settings  # where to, and how
        self._holder: object | None = None
        self._puppet: Puppet | None = None
        try:
            found = socket.getaddrinfo(settings.host, settings.port, type=socket.SOCK_DGRAM)[0]
        except OSError as error:
            reason = error.strerror or error
            raise InputError(f"vmc: {settings.host}: {reason}; name the receiver's HOST or HOST:PORT") from None
        self._address = found[4]
        self._socket = socket.socket(found[0], socket.SOCK_DGRAM)
        self._socket.setblocking(False)

    def show(self, holder: object, humanoid: Humanoid, moment: VmcMoment) -> bool:
        """Send one frame, if nobody else holds the stream; whether that is so.

        A receiver that is not there, or too slow, misses frames; nobody waits for it.
        """
        if self._holder not in (None, holder):
            return False
        self._holder = holder
        if self._puppet is None or self._puppet.humanoid is not humanoid:
            self._puppet = Puppet.of(humanoid)
        for packet in packets(messages(self._puppet, moment, self.settings.locomotion), bundles=self.settings.bundles):
            with contextlib.suppress(OSError):
                self._socket.sendto(packet, self._address)
        return True

    def release(self, holder: object) -> None:
        """Let somebody else show."""
        if self._holder is holder:
            self._holder = None

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def __enter__(self) -> "VmcStream":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def packets(told: Iterator[Message], *, bundles: bool) -> Iterator[bytes]:
    """The messages as OSC packets: bundles of at most 1,400 bytes, or each message by itself."""
    built = [_built(message) for message in told]
    if not bundles:
        yield from (message.dgram for message in built)
        return
    pending: list[OscMessage] = []
    size = _BUNDLE_HEAD
    for message in built:
        if pending and size + _LENGTH + message.size > _FITS:
            yield _bundle(pending)
            pending, size = [], _BUNDLE_HEAD
        pending.append(message)
        size += _LENGTH + message.size
    if pending:
        yield _bundle(pending)


def _built(message: Message) -> OscMessage:
    builder = OscMessageBuilder(message[0])
    for value in message[1]:
        builder.add_arg(value, {int: "i", float: "f", str: "s"}[type(value)])
    return builder.build()


def _bundle(contents: list[OscMessage]) -> bytes:
    builder = OscBundleBuilder(IMMEDIATELY)
    for message in contents:
        builder.add_content(message)
    dgram: bytes = builder.build().dgram
    return dgram
