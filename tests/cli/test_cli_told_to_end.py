"""A command that is told to end (SIGTERM) ends what it has begun."""

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

PATIENCE = 60.0  # seconds


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="children are looked up in /proc")
def test_the_server_of_doctor_ends_with_it() -> None:
    call = [sys.executable, "-m", "elbowroom", "doctor", "--session", "--scene", "a"]
    doctor = subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        assert _until(lambda: bool(_servers_of(doctor.pid)))
        (server,) = _servers_of(doctor.pid)
        doctor.send_signal(signal.SIGTERM)
        assert doctor.wait(PATIENCE) == 128 + signal.SIGTERM
        assert _until(lambda: not Path(f"/proc/{server}").exists())
    finally:
        doctor.kill()
        doctor.wait()


def _servers_of(parent: int) -> list[int]:
    """Processes that `parent` has begun which run `elbowroom play`."""
    try:
        found = [int(child) for child in Path(f"/proc/{parent}/task/{parent}/children").read_text().split()]
    except OSError:
        return []
    return [child for child in found if b"\0play\0" in _command_line(child)]


def _command_line(process: int) -> bytes:
    try:
        return Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:
        return b""


def _until(condition: Callable[[], bool]) -> bool:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.1)
    return True


TOLD_TWICE = """
import os, signal
import elbowroom.cli.main as main

def command(standalone_mode):
    try:
        os.kill(os.getpid(), signal.SIGTERM)
    finally:
        os.kill(os.getpid(), signal.SIGTERM)
        print("put away")

main.app = command
main.run()
"""


def test_who_is_told_to_end_twice_puts_away_what_was_begun() -> None:
    ran = subprocess.run([sys.executable, "-c", TOLD_TWICE], check=False, capture_output=True, text=True)
    assert (ran.returncode, ran.stdout, ran.stderr) == (128 + signal.SIGTERM, "put away\n", "")


BROKEN_OFF = """
import elbowroom.cli.main as main

def command(standalone_mode):
    try:
        raise {cause}
    except BaseException as within:
        raise SystemError("a compiled function returned a result with an exception set") from within

main.app = command
main.run()
"""


@pytest.mark.parametrize(
    ("cause", "code", "traceback"),
    [("SystemExit(143)", 143, False), ("KeyboardInterrupt", 130, False), ("ValueError", 1, True)],
)
def test_who_is_broken_off_within_a_kernel_ends_as_elsewhere(cause: str, code: int, traceback: bool) -> None:
    call = [sys.executable, "-c", BROKEN_OFF.format(cause=cause)]
    ran = subprocess.run(call, check=False, capture_output=True, text=True)
    assert ran.returncode == code
    assert ("Traceback" in ran.stderr) is traceback
