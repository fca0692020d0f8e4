"""One process compiles a kernel, others wait for it; nobody waits for ever, and who waits for itself does not."""

import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from elbowroom import kernel_turns
from elbowroom.kernel_turns import Turn

# Several such compile the same: each counts what it did itself, and reads what another has kept.
PROGRAM = """
import sys, time
from pathlib import Path
from elbowroom.kept_kernels import KeptKernel

class Slow:
    def load_overload(self, signature, context):
        file = Path(sys.argv[1]) / f"{signature}.code"
        return file.read_text() if file.exists() else None
    def save_overload(self, signature, code):
        (Path(sys.argv[1]) / f"{signature}.code").write_text(code)

kernel, mine = KeptKernel(Slow(), Path(sys.argv[1]), "k"), 0
for signature in "abc":
    if kernel.load_overload(signature, None) is None:
        time.sleep(0.2)
        mine += 1
        kernel.save_overload(signature, "code")
print(mine)
"""


def test_what_several_need_is_compiled_once(tmp_path: Path) -> None:
    command = [sys.executable, "-c", PROGRAM, str(tmp_path)]
    others = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    made = [int(other.communicate()[0]) for other in others]
    assert sum(made) == 3
    assert not list(tmp_path.glob("*.lock"))


def test_who_ends_in_the_middle_is_not_waited_for(tmp_path: Path) -> None:
    imports = "import os, sys; from pathlib import Path; from elbowroom.kernel_turns import Turn"
    program = f"{imports}; Turn(Path(sys.argv[1])).take(); os._exit(1)"
    subprocess.run([sys.executable, "-c", program, str(tmp_path / "k.lock")], check=False)
    began = time.monotonic()
    Turn(tmp_path / "k.lock").take()
    assert time.monotonic() - began < 5.0


def test_who_has_waited_long_does_it_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel_turns, "_LONG", 0.1)
    one, other = Turn(tmp_path / "k.lock"), Turn(tmp_path / "k.lock")
    one.take()
    other.take()
    other.give_up()
    one.give_up()


def test_a_kernel_may_need_itself(tmp_path: Path) -> None:
    turn = Turn(tmp_path / "k.lock")
    turn.take()
    turn.take()
    turn.give_up()
    taken = threading.Event()

    def wait() -> None:
        Turn(tmp_path / "k.lock").take()
        taken.set()

    other = threading.Thread(target=wait)
    other.start()
    assert not taken.wait(0.2)
    turn.give_up()
    assert taken.wait(5.0)
    other.join()


def test_a_folder_that_cannot_be_written_to_is_no_fault(tmp_path: Path) -> None:
    turn = Turn(tmp_path / "none" / "k.lock")
    turn.take()
    turn.give_up()
    assert not list(tmp_path.iterdir())


def test_where_files_cannot_be_locked_nobody_waits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object) -> None:
        raise OSError(37, "No locks available")

    monkeypatch.setattr("fcntl.flock", none)
    began = time.monotonic()
    turn = Turn(tmp_path / "k.lock")
    turn.take()
    turn.give_up()
    assert time.monotonic() - began < 5.0
