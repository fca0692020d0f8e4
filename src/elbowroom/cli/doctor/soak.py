"""A server under clients that come, go, upload and misbehave: whether its memory stays, and its frames come in time."""

import contextlib
import json
import logging
import os
import random
import socket
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from statistics import median
from typing import NamedTuple
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from elbowroom.body.stock import stock_avatar_path
from elbowroom.cli.doctor.load import ON_TIME, percent
from elbowroom.cli.doctor.session_cost import client_of, started_server, usage, wait_until_warm, walk_about
from elbowroom.server.schema.bounds import MAX_MESSAGE
from elbowroom.server.schema.commands import Configure, Ping
from elbowroom.server.schema.menus import Settings
from elbowroom.server.schema.progress import Notice
from elbowroom.server.sessions.meter import LATE
from elbowroom.server.wire.codec import decode_server, encode

SLOPE_BUDGET = 10.0  # MB an hour
CLIENTS = 2  # who come and go at a time
_EVERY = 2.0  # seconds between two readings of the memory
_WARM_UP = 0.3  # of the time: then everything has happened at least once
_VERDICT = 10.0  # minutes after the warm-up; in less, the noise of the heap is larger than the budget
_SCENES = ("a", "b", "c", "d", "doorway", "beam", "traffic", "empty")
_STEADY = 5.0  # seconds of walking between two looks at the clock
_PATIENCE = 60.0  # seconds in which a scene should be shown
_TOLD = 200  # characters of an error

_PILLARS = 60
_SIDES = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))  # of a box: its corners

# Files that ask for too much: objects of few bytes, and a document type that gives every element 2 MB.
_OBJECTS = b'{"asset":{"version":"2.0"},"a":[' + b"{}," * 1_000_000 + b"{}]}"
_TYPES = (
    b'<!DOCTYPE X3D [<!ATTLIST Group a CDATA "' + b"x" * 2_000_000 + b'">]><X3D><Scene>'
    + b"<Group/>" * 1000 + b"</Scene></X3D>"
)  # fmt: skip


@dataclass(frozen=True)
class Soak:
    """What came of it."""

    minutes: float  # that were wanted
    ran: float  # minutes: fewer where it was cut short
    sessions: int
    courses: int
    uploads: int
    misdeeds: int
    failures: dict[str, int]  # what went wrong with clients that behave, by name
    own_first: float  # MB of the server's own, after the warm-up
    own_last: float
    own_most: float
    kernels_first: int  # in the server's memory, after the warm-up: each is loaded when it is first needed
    kernels_last: int
    slope: float  # MB an hour after the warm-up
    slope_budget: float
    long_enough: bool  # for a verdict on the slope
    on_time_percent: float  # of all frames after the warm-up, at most `late_budget_ms` after they were due
    on_time_budget_percent: float
    late_budget_ms: float
    late_ms_p99: float  # of the frames of a client that walks about all the time, in its worst 10 s
    late_ms_typical: float  # the same in half of the times that it looked
    frames_per_second: float  # that it got
    cpu_percent: float  # of one core: the server, after the warm-up
    clients_cpu_percent: float  # the same of all clients, from their start


class _Reading(NamedTuple):
    """What the server tells of itself."""

    at: float  # seconds since the clients began
    own: float  # MB of memory
    frames: float  # of all sessions
    late: float  # of these
    processor: float  # seconds
    kernels: int  # in memory


@dataclass
class _Yard:
    """What the clients share."""

    url: str
    end: float  # of the clock
    counts: Counter[str] = field(default_factory=Counter)
    failures: Counter[str] = field(default_factory=Counter)
    late: list[float] = field(default_factory=list)
    frames: int = 0
    lock: threading.Lock = field(default_factory=threading.Lock)

    def over(self) -> bool:
        return time.monotonic() >= self.end

    @contextlib.contextmanager
    def ended_early(self) -> Iterator[None]:
        """Who interrupts the block, or tells the process to end, ends the clients' time: there is a verdict still."""
        try:
            yield
        except (KeyboardInterrupt, SystemExit):
            self.end = 0.0

    def count(self, what: str) -> None:
        with self.lock:
            self.counts[what] += 1

    def failed(self, error: Exception) -> None:
        if self.over():
            return  # what a cut takes along
        with self.lock:
            self.failures[f"{type(error).__name__}: {error}"[:_TOLD]] += 1


def soak(minutes: float, clients: int = CLIENTS, tell: Callable[[str], object] = lambda _: None) -> Soak:
    """Run a server and its clients for so long, or until it is interrupted; `tell` hears how it goes.

    `clients`: how many come and go at a time, beside one who walks on, one who uploads and one who misbehaves.
    Raises `InputError` if there is no server.
    """
    logging.getLogger("websockets").setLevel(logging.CRITICAL)  # clients that are cut off are what is wanted
    tasks = [_steady, _upload, _misbehave, *[_guest] * clients]
    with started_server("a", dict(os.environ)) as url:
        wait_until_warm(url)
        yard = _Yard(url, time.monotonic() + 60.0 * minutes)
        began, spent = time.monotonic(), time.process_time()
        readings = [_reading(yard, began)]
        with ThreadPoolExecutor(len(tasks)) as pool:
            work = [pool.submit(_again, yard, task, number) for number, task in enumerate(tasks)]
            with yard.ended_early():
                _watch(yard, readings, began, tell)
            seconds = time.monotonic() - began
            for task in work:
                task.result()
        return summary(yard, readings, minutes, (seconds, time.process_time() - spent))


def summary(yard: _Yard, readings: list[_Reading], minutes: float, took: tuple[float, float]) -> Soak:
    """What came of it by some readings, one at least; `took`: seconds by the clock and of the clients' processor."""
    seconds, spent = took
    after = [reading for reading in readings if reading.at >= _WARM_UP * min(60.0 * minutes, seconds)] or readings[-1:]
    times, own, frames, late, processor, kernels = np.array(after).T
    return Soak(
        minutes=minutes,
        ran=seconds / 60.0,
        sessions=yard.counts["sessions"],
        courses=yard.counts["courses"],
        uploads=yard.counts["uploads"],
        misdeeds=yard.counts["misdeeds"],
        failures=dict(yard.failures),
        own_first=float(own[0]),
        own_last=float(own[-1]),
        own_most=float(own.max()),
        kernels_first=int(kernels[0]),
        kernels_last=int(kernels[-1]),
        slope=slope_of(times / 3600.0, own),
        slope_budget=SLOPE_BUDGET,
        long_enough=bool(times[-1] - times[0] >= 60.0 * _VERDICT),
        on_time_percent=percent(float(frames[-1] - frames[0]), float(late[-1] - late[0])),
        on_time_budget_percent=ON_TIME,
        late_budget_ms=1e3 * LATE,
        late_ms_p99=max(yard.late, default=0.0),
        late_ms_typical=median(yard.late or [0.0]),
        frames_per_second=yard.frames / seconds,
        cpu_percent=100.0 * float(processor[-1] - processor[0]) / max(float(times[-1] - times[0]), _EVERY),
        clients_cpu_percent=100.0 * spent / seconds,
    )


def slope_of(times: "np.ndarray[tuple[int], np.dtype[np.float64]]", values: object) -> float:
    """The slope that half of all pairs of readings exceed (Theil and Sen): single peaks do not count."""
    values = np.asarray(values, np.float64)
    later, sooner = np.triu_indices(len(times), 1)[::-1]
    return float(np.median((values[later] - values[sooner]) / (times[later] - times[sooner]))) if len(later) else 0.0


def _watch(yard: _Yard, readings: list[_Reading], began: float, tell: Callable[[str], object]) -> None:
    """Gather what the server tells of itself until the end."""
    while not yard.over():
        with contextlib.suppress(OSError):
            readings.append(_reading(yard, began))
            tell(_told(yard, readings))
        time.sleep(_EVERY)


def _reading(yard: _Yard, began: float) -> _Reading:
    told = usage(yard.url)
    own, at = told["ownBytes"] / 1e6, time.monotonic() - began
    return _Reading(at, own, told["frames"], told["framesLate"], told["cpuSeconds"], int(told["kernels"]))


def _told(yard: _Yard, readings: list[_Reading]) -> str:
    """All that is known so far, in a line."""
    first, last = readings[0], readings[-1]
    on_time = percent(last.frames - first.frames, last.late - first.late)
    counts = ", ".join(f"{yard.counts[what]} {what}" for what in ("sessions", "courses", "uploads", "misdeeds"))
    failures = f", failures: {dict(yard.failures)}" if yard.failures else ""
    size = f"{last.own:.1f} MB, {last.kernels} kernels"
    return f"{last.at / 60.0:.1f} min, {size}, {on_time:.3f} % of frames in time, {counts}{failures}"


def _again(yard: _Yard, task: Callable[[_Yard, random.Random], None], number: int) -> None:
    """Do something until the end, whatever comes of it."""
    chance = random.Random(number)
    while not yard.over():
        try:
            task(yard, chance)
        except (OSError, ConnectionClosed, TimeoutError) as error:
            yard.failed(error)
            time.sleep(1.0)


# --- clients that behave -----------------------------------------------------------------------------------------


def _steady(yard: _Yard, chance: random.Random) -> None:
    """One who walks about to the end."""
    del chance
    with client_of(yard.url) as client:
        while not yard.over():
            tally = walk_about(client, _STEADY)
            yard.frames += tally.frames
            if tally.status is not None:
                yard.late.append(tally.status.late_ms_p99)


def _guest(yard: _Yard, chance: random.Random) -> None:
    """Comes, looks at a scene or a random course, walks a little, and goes, sometimes without a word."""
    with client_of(yard.url) as client:
        yard.count("sessions")
        scene = chance.choice(_SCENES)
        if chance.random() < 0.3:
            scene = f"gauntlet:{chance.randint(1, 5)}:{chance.randint(1, 10**6)}"
            yard.count("courses")
        client.send(encode(Configure(scene=scene, queue_size=chance.choice((3, 5, 7)))))
        _until_shown(client, scene)
        walk_about(client, chance.uniform(1.0, 4.0))
        if chance.random() < 0.5:
            client.socket.shutdown(socket.SHUT_RDWR)


def _until_shown(client: ClientConnection, scene: str) -> None:
    """Stay until the scene is there, which takes a while where it has to be made, or the server tells of an error."""
    end = time.monotonic() + _PATIENCE
    while time.monotonic() < end:
        message = client.recv(timeout=_PATIENCE)
        told = None if isinstance(message, bytes) else decode_server(message)
        if isinstance(told, Settings) and told.scene == scene:
            return
        if isinstance(told, Notice) and told.level == "error":
            return


def _upload(yard: _Yard, chance: random.Random) -> None:
    """Sends an avatar and a place and walks with them; now and then a file that asks for too much."""
    avatar = _post(yard.url, "mine.vrm", stock_avatar_path().read_bytes())["avatar"]["id"]
    place = _post(yard.url, "hall.obj", _hall(chance))["scene"]["name"]
    yard.count("uploads")
    with client_of(yard.url) as client:
        yard.count("sessions")
        client.send(encode(Configure(avatar=avatar, scene=place)))
        _until_shown(client, place)
        walk_about(client, chance.uniform(1.0, 3.0))
    if chance.random() < 0.3:
        for name, data in (("objects.gltf", _OBJECTS), ("types.x3d", _TYPES)):
            with contextlib.suppress(HTTPError):
                _post(yard.url, name, data)
            yard.count("misdeeds")


def _hall(chance: random.Random) -> bytes:
    """The model of a hall with pillars here and there, as OBJ."""
    boxes = [(0.0, -0.1, 0.0, 12.0, 0.1, 12.0)]
    for _ in range(_PILLARS):
        boxes.append((chance.uniform(-11.0, 11.0), 1.0, chance.uniform(-11.0, 11.0), 0.2, 1.0, 0.2))
    lines = []
    for number, (x, y, z, a, b, c) in enumerate(boxes):
        lines += [f"v {x + i * a} {y + j * b} {z + k * c}" for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
        lines += ["f " + " ".join(str(8 * number + corner) for corner in side) for side in _SIDES]
    return "\n".join(lines).encode()


def _post(url: str, name: str, data: bytes) -> dict[str, dict[str, str]]:
    with urlopen(Request(f"{url}/api/avatars?name={name}", data), timeout=180.0) as answer:
        told: dict[str, dict[str, str]] = json.load(answer)
        return told


# --- and some that do not ----------------------------------------------------------------------------------------


def _misbehave(yard: _Yard, chance: random.Random) -> None:
    deed = chance.choice((_half_requests, _floods, _too_long, _never_reads, _drips))
    with contextlib.suppress(OSError, ConnectionClosed):
        deed(yard)
    yard.count("misdeeds")
    time.sleep(1.0)


def _half_requests(yard: _Yard) -> None:
    with contextlib.ExitStack() as stack:
        for _ in range(30):
            stack.enter_context(_opened(yard.url)).sendall(b"GET /api/health HTTP/1.1\r\nHost: 127")
        time.sleep(3.0)


def _floods(yard: _Yard) -> None:
    with client_of(yard.url) as client:
        for number in range(20_000):
            client.send(encode(Ping(float(number))))


def _too_long(yard: _Yard) -> None:
    with client_of(yard.url) as client:
        client.send("x" * (MAX_MESSAGE + 1))
        client.recv(timeout=5.0)


def _never_reads(yard: _Yard) -> None:
    with _opened(yard.url) as held:
        key = "dGhlIHNhbXBsZSBub25jZQ=="
        lines = ["GET /ws HTTP/1.1", f"Host: {urlsplit(yard.url).netloc}", "Connection: Upgrade", "Upgrade: websocket"]
        lines += ["Sec-WebSocket-Version: 13", f"Sec-WebSocket-Key: {key}"]
        held.sendall("\r\n".join([*lines, "", ""]).encode())
        time.sleep(5.0)


def _drips(yard: _Yard) -> None:
    with _opened(yard.url) as held:
        head = f"POST /api/avatars HTTP/1.1\r\nHost: {urlsplit(yard.url).netloc}\r\nContent-Length: 100000\r\n\r\n"
        held.sendall(head.encode())
        for _ in range(5):
            held.sendall(b"x")
            time.sleep(0.5)


def _opened(url: str) -> socket.socket:
    at = urlsplit(url)
    return socket.create_connection((at.hostname or "", at.port or 0), timeout=20.0)
