"""WebM as a naive reader of its elements finds it."""

import io
import struct
from collections.abc import Iterator

from hypothesis import given
from hypothesis import strategies as st

from elbowroom.film.webm import Packet, write_webm

SEGMENT, CLUSTER, TIME, BLOCK = 0x18538067, 0x1F43B675, 0xE7, 0xA3
PARENTS = {SEGMENT, CLUSTER, 0x1654AE6B, 0xAE, 0xE0, 0x1549A966, 0x1A45DFA3}


def elements(data: bytes, at: int = 0) -> Iterator[tuple[int, bytes]]:
    """All elements in order, parents before what is in them."""
    while at < len(data):
        length = 9 - data[at].bit_length()
        name, at = int.from_bytes(data[at : at + length], "big"), at + length
        size, at = int.from_bytes(data[at : at + 8], "big") - (1 << 56), at + 8
        content = data[at:] if name == SEGMENT else data[at : at + size]
        yield name, content
        if name in PARENTS:
            yield from elements(content)
        at += len(content)


packets = st.lists(
    st.builds(Packet, st.binary(max_size=40), st.floats(0.0, 100.0), st.booleans()), min_size=1, max_size=60
).map(lambda found: sorted(found, key=lambda packet: packet.time))


@given(packets)
def test_every_picture_is_found_again_at_its_time(given_packets: list[Packet]) -> None:
    file = io.BytesIO()
    write_webm(file, given_packets, (320, 180), "V_VP8")
    begun, found, known = 0, [], {}
    for name, content in elements(file.getvalue()):
        known[name] = content
        if name == TIME:
            begun = int.from_bytes(content, "big")
        if name == BLOCK:
            track, after, flags = struct.unpack_from(">BhB", content)
            assert track == 0x81
            found.append((begun + after, bool(flags & 0x80), content[4:]))
    assert found == [(round(packet.time * 1000), packet.key, packet.data) for packet in given_packets]
    assert known[0x86] == b"V_VP8"
    assert [int.from_bytes(known[name], "big") for name in (0xB0, 0xBA, 0x2AD7B1)] == [320, 180, 1_000_000]
