"""Connecting to a Ray cluster: one of this machine alone that ends with the call, or one that runs somewhere."""

import logging
import os
import re
import socket
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from elbowroom.errors import InputError
from elbowroom.experiment.parallel import MAX_JOBS, check_jobs, usable_cores

if TYPE_CHECKING:
    from elbowroom.cluster.nodes import Nodes, Tell
    from elbowroom.cluster.workers import RayWorkers

LOCAL = "local"

_ADDRESS = re.compile(r"[A-Za-z0-9._-]{1,253}:[0-9]{1,5}|\[[0-9A-Fa-f:]{2,45}\]:[0-9]{1,5}")
# Ray reports its use to its makers, and has its workers wait for all other programs, unless it is told not to.
_RAY = {"RAY_USAGE_STATS_ENABLED": "0", "RAY_worker_niceness": "0"}
_ANSWER = 5.0  # seconds to wait for a cluster
_MEMORY = 256 * 2**20  # bytes for what tasks ask for, on a cluster of our own


def check_address(address: str) -> None:
    """Raises `InputError` unless this may be a cluster's address and Ray is installed."""
    if address != LOCAL and not _ADDRESS.fullmatch(address):
        raise InputError(f"--cluster: {address[:80]!r} is neither `local` nor an address as 10.0.0.5:6379")
    if find_spec("ray") is None:
        raise InputError("--cluster needs Ray: pip install 'elbowroom[cluster]'")


@contextmanager
def connected(address: str, tell: "Tell", at_once: int | None = None) -> "Iterator[RayWorkers]":
    """The workers of a cluster: as `joined`; at most `at_once` tasks at the same time."""
    with joined(address, tell, at_once) as nodes:
        from elbowroom.cluster.workers import RayWorkers

        yield RayWorkers(nodes)


@contextmanager
def joined(address: str, tell: "Tell", at_once: int | None = None) -> "Iterator[Nodes]":
    """The nodes of a cluster, of which one is ready: `local`, or the address of one that runs.

    `tell` hears, in one line each, of nodes that are lost, or left out since they have another version or kind of
    processor. A local cluster takes calls only from who has its token, as Ray does by itself. Raises `InputError`
    where there is no such cluster.
    """
    check_address(address)
    if at_once is not None:
        check_jobs(at_once)
    if address != LOCAL:
        _knock(address)
    for name, value in _RAY.items():
        os.environ.setdefault(name, value)
    import ray

    from elbowroom.cluster.nodes import Nodes

    quiet: dict[str, Any] = {"log_to_driver": False, "logging_level": logging.ERROR}
    own: dict[str, Any] = {"include_dashboard": False, "object_store_memory": _MEMORY}
    try:
        if address == LOCAL:
            ray.init("local", num_cpus=at_once or usable_cores(), **own, **quiet)
        else:
            ray.init(address, **quiet)
    except (OSError, RuntimeError, ValueError) as error:
        raise InputError(f"--cluster {address}: {str(error).strip().splitlines()[0][:200]}") from None
    try:
        nodes = Nodes(at_once or MAX_JOBS, tell)
        # Ray prints twenty lines of a lost node's log on stdout; `tell` hears of it in one.
        with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere):
            nodes.wait()
            yield nodes
    finally:
        ray.shutdown()


def _knock(address: str) -> None:
    """Raises `InputError` where nobody answers: Ray itself would try for minutes."""
    host, _, port = address.rpartition(":")
    try:
        with socket.create_connection((host.strip("[]"), int(port)), _ANSWER):
            pass
    except (OSError, OverflowError) as error:  # a port beyond 65535 is an overflow
        why = str(error).strip().splitlines()[0][:200]
        mend = "start a cluster there (`ray start --head --port PORT`), or give `local` for one of this machine"
        raise InputError(f"--cluster {address}: no cluster answers: {why}; {mend}") from None
