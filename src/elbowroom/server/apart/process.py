"""Starts a process for one piece of work, waits for its answer, and ends it when nobody waits any more."""

import asyncio
import contextlib
import logging
import os
import pickle
import signal
import sys
from typing import Any

from elbowroom.errors import InputError
from elbowroom.server.apart.answers import Outcome, unpacked
from elbowroom.server.apart.bounds import Bounds

LOG = logging.getLogger("elbowroom.server")

_CHUNK = 256 * 1024  # bytes
_LONGEST_LINE = 600  # characters of a message for the user
_BOUNDS = Bounds()
_NO_THREADS = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


class FullDiskError(Exception):
    """There is no space left for what was to be written."""


class ApartError(Exception):
    """The work failed by a fault of ours; the log says more."""


class _TooLongError(Exception):
    pass


async def run_apart(job: str, name: str, *arguments: str, bounds: Bounds = _BOUNDS) -> Any:
    """What a job of `apart.jobs` makes of its arguments; `name` is what the user calls the thing.

    The process ends with this call, however that ends: when it is cancelled, at once. Raises `InputError` where the
    job does, or the thing needs more than the bounds allow; `FullDiskError`; `ApartError`.
    """
    command = [sys.executable, "-m", "elbowroom.server.apart", bounds.to_text(), job, *arguments]
    process = await asyncio.create_subprocess_exec(
        *command,
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.DEVNULL,
        process_group=0,  # Ctrl-C is for the server alone; a session of its own would have a share of time of its own
        env=os.environ | _NO_THREADS,
    )
    try:
        async with asyncio.timeout(bounds.wall):
            answer = await _answer_of(process, bounds.answer)
            await process.wait()
    except TimeoutError:
        raise InputError(f"{name}: takes more than {bounds.wall:g} s") from None
    except _TooLongError:
        raise InputError(f"{name}: unpacks to more than {bounds.answer >> 20} MiB") from None
    finally:
        await _end(process)
    return _made(answer, process.returncode or 0, name, bounds)


async def _answer_of(process: asyncio.subprocess.Process, most: int) -> bytes:
    assert process.stdout is not None
    answer = bytearray()
    while chunk := await process.stdout.read(_CHUNK):
        answer += chunk
        if len(answer) > most:
            raise _TooLongError
    return bytes(answer)


async def _end(process: asyncio.subprocess.Process) -> None:
    """Kill it, if it still runs, and see it off: without that its pipes would stay open."""
    assert process.stdin is not None
    assert process.stdout is not None
    with contextlib.suppress(ProcessLookupError):
        _kill(process)
    process.stdin.close()
    while await process.stdout.read(_CHUNK):
        pass
    await process.wait()


def _kill(process: asyncio.subprocess.Process) -> None:
    """As `Process.kill`, which up to Python 3.12 asks first how the process ended, and so may take the answer from
    asyncio's own watcher: that then warns of an unknown child.
    """
    if sys.platform == "win32":
        process.kill()
    elif process.returncode is None:
        os.kill(process.pid, signal.SIGKILL)


def _made(answer: bytes, code: int, name: str, bounds: Bounds) -> Any:
    try:
        outcome, told = Outcome(answer[:1]), answer[1:]
    except ValueError:
        raise InputError(_ended(code, name, bounds)) from None
    if outcome is Outcome.WRONG:
        raise InputError(" ".join(told.decode("utf-8", "replace").split())[:_LONGEST_LINE])
    if outcome is Outcome.MEMORY:
        raise InputError(_too_much_memory(name, bounds))
    if outcome is Outcome.DISK:
        raise FullDiskError
    if outcome is Outcome.FAILED:
        LOG.error("%s could not be read: %s", name, told.decode("utf-8", "replace"))
        raise ApartError
    try:
        return unpacked(told)
    except pickle.UnpicklingError as error:
        LOG.error("%s: its reader's answer is not one: %s", name, error)
        raise ApartError from None


def _ended(code: int, name: str, bounds: Bounds) -> str:
    """Why a process ended without a word."""
    if code in (-getattr(signal, "SIGXCPU", 24), -signal.SIGKILL if sys.platform != "win32" else 1):
        return f"{name}: takes more than {bounds.processor} s of a processor, or more memory than there is"
    LOG.warning("%s: its reader ended with %d", name, code)
    return f"{name}: cannot be read: it ends its reader ({_name_of(code)})"


def _too_much_memory(name: str, bounds: Bounds) -> str:
    return f"{name}: takes more than {bounds.memory >> 20} MiB of memory"


def _name_of(code: int) -> str:
    try:
        return signal.Signals(-code).name
    except ValueError:
        return f"exit code {code}"
