"""`elbowroom doctor --load`: many users who steer as real ones do, and whether a server keeps its promises to them."""

import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from statistics import median
from typing import NamedTuple

from websockets.exceptions import WebSocketException

from elbowroom.cli.doctor.session_cost import Tally, client_of, started_server, usage, wait_until_warm, walk_about
from elbowroom.errors import InputError
from elbowroom.experiment.bench.steer_scenes import Steer, steered_scenes
from elbowroom.server.schema.commands import Configure
from elbowroom.server.sessions.meter import LATE, PROMPT
from elbowroom.server.wire.codec import encode

ON_TIME = 99.0  # percent of the frames

_STEERING = ("d", "d, keys", "c", "traffic")  # mouse-look, key flips, mouse-look, stop-and-go; by turns
_APART = 0.3  # seconds between two users who come
_SETTLE = 4.0  # seconds of steering before it is measured
_AGAIN, _TRIES = 1.0, 8  # seconds after which a user who was refused comes again, and how often


@dataclass(frozen=True)
class Load:
    """What came of it; the processor's and the memory's shares are those of the users who were served."""

    sessions: int  # that were wanted
    served: int  # to the end
    seconds: float
    frames_per_second: float  # of each session; fewer are sent while an avatar stands
    on_time_percent: float  # of all frames, at most `late_budget_ms` after they were due
    on_time_budget_percent: float
    late_budget_ms: float
    late_ms_p99: float  # of the session that was latest
    answer_ms_p50: float  # from a changed command until the motion is planned for it, of the median session
    answer_ms_p99: float  # of all commands: an upper bound from the server's counts
    answered_in_time_percent: float
    answer_budget_ms: float
    cpu_percent: float  # of one core
    own_megabytes: float  # beyond what the server held before the first came
    clients_cpu_percent: float  # of one core: of the users, who may be on the same machine


class _User(NamedTuple):
    """One who steers."""

    scene: str
    hand: Callable[[], Steer]
    delay: float  # seconds until it comes


def measure_load(sessions: int, seconds: float, url: str | None = None) -> Load:
    """So many users steer servers of its own, or those at an address, for so long.

    Its own are what `serve` starts, or where there is no Ray for that, the one of `play`. Raises `InputError` where
    there is no server.
    """
    own = partial(started_server, "d", dict(os.environ), many=find_spec("ray") is not None)
    with own() if url is None else nullcontext(url.rstrip("/")) as address:
        try:
            wait_until_warm(address)
        except (OSError, ValueError):
            raise InputError(f"--at {address}: no server of elbowroom answers there") from None
        return _measured(address, sessions, seconds)


def load_faults(load: Load) -> list[str]:
    """Which promises were broken."""
    faults = []
    if load.served < load.sessions:
        faults.append(f"only {load.served} of {load.sessions} users were served")
    if load.on_time_percent < load.on_time_budget_percent:
        faults.append(f"more frames than 1 in 100 were over {load.late_budget_ms:g} ms late")
    if load.answered_in_time_percent < load.on_time_budget_percent:
        faults.append(f"more commands than 1 in 100 were answered after more than {load.answer_budget_ms:g} ms")
    return faults


def _measured(url: str, sessions: int, seconds: float) -> Load:
    users = list(_users(sessions))
    start = usage(url)
    begun = time.monotonic() + _APART * sessions + _SETTLE
    with ThreadPoolExecutor(sessions) as threads:
        work = [threads.submit(_steer, url, user, begun, seconds) for user in users]
        time.sleep(max(begun - time.monotonic(), 0.0))
        before, own_before = usage(url), time.process_time()
        time.sleep(max(begun + seconds - time.monotonic(), 0.0))
        after, own_after = usage(url), time.process_time()
        tallies = [tally for task in work if (tally := task.result()) is not None]
    return _told(sessions, tallies, (start, before, after), own_after - own_before)


def _told(sessions: int, tallies: list[Tally], read: tuple[dict[str, float], ...], own: float) -> Load:
    start, before, after = read
    spent = {name: after[name] - before[name] for name in before if isinstance(before[name], int | float)}
    wall, served = spent["wallSeconds"], max(len(tallies), 1)
    told = [tally.status for tally in tallies if tally.status is not None]
    answers = [status.answer_ms for status in told if status.answer_ms is not None]
    return Load(
        sessions=sessions,
        served=len(tallies),
        seconds=wall,
        frames_per_second=sum(tally.frames for tally in tallies) / wall / served,
        on_time_percent=percent(spent["frames"], spent["framesLate"]),
        on_time_budget_percent=ON_TIME,
        late_budget_ms=1e3 * LATE,
        late_ms_p99=max((status.late_ms_p99 for status in told), default=0.0),
        answer_ms_p50=median(half for half, _, _ in answers) if answers else 0.0,
        answer_ms_p99=max((most for _, most, _ in answers), default=0.0),
        answered_in_time_percent=percent(spent["answers"], spent["answersLate"]),
        answer_budget_ms=1e3 * PROMPT,
        cpu_percent=100.0 * spent["cpuSeconds"] / wall / served,
        own_megabytes=(after["ownBytes"] - start["ownBytes"]) / 1e6 / served,
        clients_cpu_percent=100.0 * own / wall,
    )


def percent(count: float, bad: float) -> float:
    """The share of what was not bad."""
    return 100.0 * (1.0 - bad / count) if count else 100.0


def _users(count: int) -> Iterator[_User]:
    kinds = steered_scenes(_STEERING)
    for number in range(count):
        kind = kinds[number % len(kinds)]
        yield _User(kind.scene.name, partial(kind.hand, kind.route), _APART * number)


def _steer(url: str, user: _User, begun: float, seconds: float) -> Tally | None:
    """One user's time there, of which the measured part is counted; None for one who was not served to the end."""
    time.sleep(user.delay)
    for _ in range(_TRIES):
        with suppress(OSError, WebSocketException), client_of(url) as client:
            client.send(encode(Configure(scene=user.scene)))
            walk_about(client, max(begun - time.monotonic(), 0.1), user.hand)
            return walk_about(client, max(begun + seconds - time.monotonic(), 0.1), user.hand)
        time.sleep(_AGAIN)
    return None
