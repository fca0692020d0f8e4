"""What one live session costs: a real server in its own process, a real client that walks in circles."""

import json
import re
import subprocess
import sys
import time
from dataclasses import dataclass
from urllib.request import urlopen

from websockets.sync.client import ClientConnection, connect

from elbowroom.errors import InputError
from elbowroom.server.codec import decode_server, encode
from elbowroom.server.messages import Input, Reset, Status

CPU_BUDGET = 25.0  # percent of one core
RESIDENT_BUDGET = 400.0  # MB

_PATIENCE = 300.0  # seconds until the server answers, the first time with compiling
_SETTLE = 2.0  # seconds of walking before the measurement
_HEARTBEAT = 0.2  # seconds between inputs
_RESTART = 12.0  # seconds of walking between two resets: the scenes' obstacles, again and again


@dataclass(frozen=True)
class SessionCost:
    """The server's side of one live session at 60 Hz."""

    seconds: float
    cpu_percent: float  # of one core, all threads
    cpu_budget_percent: float
    resident_megabytes: float
    resident_budget_megabytes: float
    frames_per_second: float
    frame_ms_p50: float
    frame_ms_p95: float
    ready_seconds: float  # from the start of the process until it serves


@dataclass
class _Tally:
    """What the client has received."""

    frames: int = 0
    status: Status | None = None


def measure_session(seconds: float, scene: str) -> SessionCost:
    """Run a server and a client for `seconds`; raises `InputError` if the server does not start."""
    began = time.perf_counter()
    command = "import sys; from elbowroom.cli import main; sys.argv[0] = 'elbowroom'; main()"
    arguments = ["play", "--port", "0", "--no-open", "--scene", scene]
    with subprocess.Popen([sys.executable, "-c", command, *arguments], stdout=subprocess.PIPE, text=True) as server:
        try:
            url = _url(server)
            return _measured(url, seconds, time.perf_counter() - began)
        finally:
            server.terminate()


def _url(server: "subprocess.Popen[str]") -> str:
    assert server.stdout is not None
    for line in server.stdout:
        found = re.search(r"http://\S+", line)
        if found:
            return found[0]
    raise InputError("doctor: the server did not start; `elbowroom play --no-open` says why")


def _measured(url: str, seconds: float, ready: float) -> SessionCost:
    with connect(url.replace("http", "ws", 1) + "/ws", compression=None, proxy=None, open_timeout=_PATIENCE) as client:
        _walk(client, _SETTLE)
        before = _usage(url)
        tally = _walk(client, seconds)
        after = _usage(url)
    wall = after["wallSeconds"] - before["wallSeconds"]
    status = tally.status
    return SessionCost(
        seconds=wall,
        cpu_percent=100.0 * (after["cpuSeconds"] - before["cpuSeconds"]) / wall,
        cpu_budget_percent=CPU_BUDGET,
        resident_megabytes=after["residentBytes"] / 1e6,
        resident_budget_megabytes=RESIDENT_BUDGET,
        frames_per_second=tally.frames / wall,
        frame_ms_p50=status.frame_ms_p50 if status else 0.0,
        frame_ms_p95=status.frame_ms_p95 if status else 0.0,
        ready_seconds=ready,
    )


def _walk(client: ClientConnection, seconds: float) -> _Tally:
    """Hold the forward key for `seconds`, going back to the start now and then."""
    tally = _Tally()
    end = time.monotonic() + seconds
    next_input, next_reset, seq = 0.0, time.monotonic() + _RESTART, 0
    while time.monotonic() < end:
        if time.monotonic() >= next_reset:
            next_reset += _RESTART
            client.send(encode(Reset()))
        if time.monotonic() >= next_input:
            next_input = time.monotonic() + _HEARTBEAT
            seq += 1
            client.send(encode(Input(seq=seq, forward=1.0)))
        message = client.recv(timeout=_PATIENCE)
        if isinstance(message, bytes):
            tally.frames += 1
        else:
            parsed = decode_server(message)
            tally.status = parsed if isinstance(parsed, Status) else tally.status
    return tally


def _usage(url: str) -> dict[str, float]:
    with urlopen(f"{url}/api/health", timeout=10.0) as response:
        usage: dict[str, float] = json.load(response)
    return usage
