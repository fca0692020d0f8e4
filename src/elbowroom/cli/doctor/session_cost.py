"""What live sessions cost and how punctual they are: a real server in its own process, real clients that walk about."""

import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from statistics import median
from urllib.request import urlopen

import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from elbowroom.errors import InputError
from elbowroom.experiment.bench.steer_scenes import Steer, keys
from elbowroom.planning.command import Command
from elbowroom.server.schema.commands import Input, Reset
from elbowroom.server.schema.progress import Status
from elbowroom.server.wire.codec import decode_server, encode
from elbowroom.server.wire.pose_frame import parse

CPU_BUDGET = 25.0  # percent of one core
OWN_BASE, OWN_EACH = 175.0, 25.0  # MB of the process, compiled kernels most of all, and of each session
ANSWER_AIM = 100.0  # ms

_PATIENCE = 300.0  # seconds until the server answers, the first time with compiling
_SETTLE = 2.0  # seconds of walking before the measurement
_HEARTBEAT = 0.2  # seconds between inputs that are all the same
_RESTART = 12.0  # seconds of walking between two resets, at most: the scenes' obstacles, again and again


@dataclass(frozen=True)
class SessionCost:
    """The server's side of live sessions at 60 Hz."""

    sessions: int
    seconds: float
    cpu_percent: float  # of one core, all threads, for each session
    cpu_budget_percent: float
    resident_megabytes: float  # with what lies in memory of the libraries' files: the system's choice
    own_megabytes: float  # without
    own_budget_megabytes: float  # of a process with so many sessions
    frames_per_second: float  # of each session
    frame_ms_p50: float
    frame_ms_p95: float
    late_ms_p99: float  # how long after it was due a frame was ready; of the latest session
    answer_ms_p50: float  # from a changed command until the motion is planned for it
    answer_ms_p99: float  # of the session that waited longest
    answer_ms_max: float
    answer_aim_ms: float
    late_plans: int
    ready_seconds: float  # from the start of the process until it serves


@dataclass
class Tally:
    """What the client has received."""

    frames: int = 0
    status: Status | None = None


def memory_budget(sessions: int) -> float:
    """What a server may hold of its own, MB: sessions share the process, its kernels and the avatar's model."""
    return OWN_BASE + OWN_EACH * sessions


def measure_session(
    seconds: float, scene: str, sessions: int = 1, hand: Callable[[], Steer] | None = None
) -> SessionCost:
    """Run a server and clients for `seconds`; raises `InputError` if the server does not start.

    `hand` makes the user who steers a session from its start to the finish, or for a while, and then another; by
    default one who walks mostly ahead.
    """
    began = time.perf_counter()
    with started_server(scene, dict(os.environ)) as url, _all_admitted(sessions):
        return _measured(url, seconds, sessions, hand, time.perf_counter() - began)


@contextmanager
def _all_admitted(sessions: int) -> Iterator[None]:
    try:
        yield
    except ConnectionClosed:
        raise InputError(f"this machine is too busy for {sessions} sessions at once; see `doctor --load`") from None


@contextmanager
def started_server(scene: str, environment: dict[str, str], *, many: bool = False) -> Iterator[str]:
    """The address of `elbowroom play` in a process of its own, or of `serve`, which is for `many` users.

    Raises `InputError` if it does not start.
    """
    command = "import sys; from elbowroom.cli import main; sys.argv[0] = 'elbowroom'; main()"
    called = ["serve"] if many else ["play", "--no-open"]
    call = [sys.executable, "-c", command, *called, "--port", "0", "--scene", scene]
    told = subprocess.STDOUT if many else None  # where `serve` says its address
    with subprocess.Popen(call, stdout=subprocess.PIPE, stderr=told, text=True, env=environment) as server:
        try:
            yield _url(server)
        finally:
            server.terminate()


def wait_for_plan(url: str) -> None:
    """Hold the forward key until a plan has come."""
    with client_of(url) as client:
        client.send(encode(Input(seq=1, forward=1.0)))
        while True:
            message = client.recv(timeout=_PATIENCE)
            told = None if isinstance(message, bytes) else decode_server(message)
            if isinstance(told, Status) and told.plans > 0:
                return


def _url(server: "subprocess.Popen[str]") -> str:
    assert server.stdout is not None
    for line in server.stdout:
        found = re.search(r"http://\S+", line)
        if found:
            return found[0]
    raise InputError("doctor: the server did not start; `elbowroom play --no-open` says why")


def _measured(url: str, seconds: float, sessions: int, hand: Callable[[], Steer] | None, ready: float) -> SessionCost:
    wait_until_warm(url)
    with ExitStack() as stack, ThreadPoolExecutor(sessions) as threads:
        clients = [stack.enter_context(client_of(url)) for _ in range(sessions)]
        list(threads.map(partial(walk_about, seconds=_SETTLE, hand=hand), clients))
        before = usage(url)
        tallies = list(threads.map(partial(walk_about, seconds=seconds, hand=hand), clients))
        after = usage(url)
    wall = after["wallSeconds"] - before["wallSeconds"]
    told = [tally.status for tally in tallies if tally.status is not None]
    answers = [status.answer_ms for status in told if status.answer_ms is not None]
    return SessionCost(
        sessions=sessions,
        seconds=wall,
        cpu_percent=100.0 * (after["cpuSeconds"] - before["cpuSeconds"]) / wall / sessions,
        cpu_budget_percent=CPU_BUDGET,
        resident_megabytes=after["residentBytes"] / 1e6,
        own_megabytes=after["ownBytes"] / 1e6,
        own_budget_megabytes=memory_budget(sessions),
        frames_per_second=sum(tally.frames for tally in tallies) / wall / sessions,
        frame_ms_p50=median(status.frame_ms_p50 for status in told),
        frame_ms_p95=max(status.frame_ms_p95 for status in told),
        late_ms_p99=max(status.late_ms_p99 for status in told),
        answer_ms_p50=median(half for half, _, _ in answers) if answers else 0.0,
        answer_ms_p99=max((most for _, most, _ in answers), default=0.0),
        answer_ms_max=max((longest for _, _, longest in answers), default=0.0),
        answer_aim_ms=ANSWER_AIM,
        late_plans=sum(status.late_plans for status in told),
        ready_seconds=ready,
    )


def client_of(url: str) -> ClientConnection:
    """A client of the server at an address."""
    return connect(url.replace("http", "ws", 1) + "/ws", compression=None, proxy=None, open_timeout=_PATIENCE)


def walk_about(client: ClientConnection, seconds: float, hand: Callable[[], Steer] | None = None) -> Tally:
    """Steer for `seconds`, mostly ahead if no `hand` is given; again from the start at the finish, or after a while."""
    hand = hand or _mostly_ahead
    tally, steer, sent = Tally(), hand(), -_HEARTBEAT
    began = start = time.monotonic()
    command, number = Command(), 0
    while (now := time.monotonic()) < began + seconds:
        message = client.recv(timeout=_PATIENCE)
        if not isinstance(message, bytes):
            parsed = decode_server(message)
            tally.status = parsed if isinstance(parsed, Status) else tally.status
            continue
        pose = parse(message)
        tally.frames += 1
        if pose.flag("finished") or now > start + _RESTART:
            client.send(encode(Reset()))
            steer, start = hand(), now
            continue
        wanted = steer(now - start, pose.x, pose.z)
        if wanted != command or now > sent + _HEARTBEAT:
            command, sent, number = wanted, now, number + 1
            client.send(encode(_input(number, command)))
    return tally


def _mostly_ahead() -> Steer:
    return keys((2.5, Command(forward=1.0)), (0.5, Command(forward=1.0, strafe=1.0)))(
        np.array([[0.0, 0.0], [0.0, 1.0]])
    )


def _input(number: int, command: Command) -> Input:
    return Input(number, command.forward, command.strafe, command.turn, command.direction, command.run)


def wait_until_warm(url: str) -> None:
    """Until the server has loaded all its kernels: what that costs is measured with the start."""
    end = time.monotonic() + _PATIENCE
    while not usage(url)["warm"]:
        if time.monotonic() > end:
            raise InputError(f"doctor: the server is not warm after {_PATIENCE:g} s; `elbowroom play` says why")
        time.sleep(0.1)


def usage(url: str) -> dict[str, float]:
    """What a server's process has cost so far, as it tells itself."""
    with urlopen(f"{url}/api/health", timeout=10.0) as response:
        told: dict[str, float] = json.load(response)
    return told
