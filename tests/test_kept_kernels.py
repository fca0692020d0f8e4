"""Compiled kernels on disk: none is read that is not as it was written, and what cannot be kept is no fault."""

import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from elbowroom import kept_kernels
from elbowroom.kept_kernels import KeptKernel, is_whole, name_of

NAME = "limb.pose-12.py311"
# A kernel of a file of its own, as the package makes them: what it computes, and how often it was compiled for that.
PROGRAM = """
import sys
sys.path.insert(0, {folder!r})
from toy import double
assert double(4.0) == 8.0
print(sum(double.stats.cache_misses.values()))
"""


class OwnCache:
    """Stands for Numba's: keeps bytes, as it does, and reads them without a question."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.cache_path = folder, str(folder)

    def load_overload(self, signature: bytes, context: object) -> bytes | None:
        assert context is None
        found = (self.folder / f"{NAME}.1.nbc").read_bytes()
        if not found.startswith(signature):
            raise EOFError("damaged")
        return found

    def save_overload(self, signature: bytes, code: bytes) -> None:
        for ending in (".nbi", ".1.nbc"):
            new = self.folder / f"{NAME}{ending}.tmp"
            new.write_bytes(signature + code)
            new.replace(self.folder / f"{NAME}{ending}")


def kept(folder: Path) -> KeptKernel:
    return KeptKernel(OwnCache(folder), folder, NAME)


def flip(file: Path) -> None:
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)


@pytest.mark.parametrize("ending", [".nbi", ".1.nbc"])
def test_a_flipped_byte_is_found_before_it_is_read(tmp_path: Path, ending: str) -> None:
    kernel = kept(tmp_path)
    kernel.save_overload(b"float", b"code" * 99)
    assert kernel.load_overload(b"float", None) == b"float" + b"code" * 99
    flip(tmp_path / f"{NAME}{ending}")
    assert kernel.load_overload(b"float", None) is None
    assert [file for file in tmp_path.iterdir() if file.suffix != ".lock"] == []  # it is this one's turn to compile it
    kernel.save_overload(b"float", b"anew")
    assert kernel.load_overload(b"float", None) == b"floatanew"


def test_what_another_program_writes_anew_is_whole(tmp_path: Path) -> None:
    """Also where that one was ended before it could say so."""
    kernel, other = kept(tmp_path), kept(tmp_path)
    kernel.save_overload(b"float", b"code")
    other.save_overload(b"float", b"other code")
    assert kernel.load_overload(b"float", None) == b"floatother code"
    (tmp_path / f"{NAME}.sum").unlink()
    OwnCache(tmp_path).save_overload(b"float", b"third")
    assert is_whole(tmp_path, NAME)
    assert kernel.load_overload(b"float", None) == b"floatthird"
    flip(tmp_path / f"{NAME}.1.nbc")  # by now it is known
    assert kernel.load_overload(b"float", None) is None


def test_what_is_damaged_before_anybody_knew_it_is_compiled_anew(tmp_path: Path) -> None:
    OwnCache(tmp_path).save_overload(b"float", b"code")
    (tmp_path / f"{NAME}.1.nbc").write_bytes(b"")
    assert kept(tmp_path).load_overload(b"float", None) is None
    assert [file for file in tmp_path.iterdir() if file.suffix != ".lock"] == []  # it is this one's turn to compile it


@pytest.mark.parametrize("damage", [b"", b"{", b"[]", b"\xff", b'{"a": "x"}'])
def test_a_damaged_checksum_is_none(tmp_path: Path, damage: bytes) -> None:
    kernel = kept(tmp_path)
    kernel.save_overload(b"float", b"code")
    (tmp_path / f"{NAME}.sum").write_bytes(damage)
    assert kernel.load_overload(b"float", None) is None


def test_a_full_disk_is_no_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    kernel = kept(tmp_path)
    monkeypatch.setattr(OwnCache, "save_overload", full)
    kernel.save_overload(b"float", b"code")
    monkeypatch.undo()
    monkeypatch.setattr(kept_kernels.Path, "write_text", full)  # type: ignore[attr-defined]
    kernel.save_overload(b"float", b"code")
    assert kernel.load_overload(b"float", None) == b"floatcode"
    assert kernel.cache_path == str(tmp_path)


TOLD = """
import os
import signal
import sys
import time
from ctypes import c_void_p, cast
from llvmlite.binding import ExecutionEngine
from elbowroom.cli.main import run
import elbowroom.cli.main as cli

found, asked = ExecutionEngine._find_module_ptr, []


def find(engine, pointer):
    asked.append(cast(pointer, c_void_p).value)
    if asked.count(asked[-1]) % 2 == 0:  # first it is asked whether its code is known, then the code is told
        os.kill(os.getpid(), getattr(signal, sys.argv[1]))
    return found(engine, pointer)


ExecutionEngine._find_module_ptr = find
sys.path.insert(0, {folder!r})


def app(**_):
    from toy import double
    double(4.0)
    time.sleep(5.0)
    print("went on")


cli.app = app
signal.signal(signal.SIGINT, signal.default_int_handler)  # programs in the background begin without
run()
"""


@pytest.mark.parametrize("sent", ["SIGINT", "SIGTERM"])
def test_who_is_told_to_end_while_machine_code_is_made_ends(tmp_path: Path, sent: str) -> None:
    """The signal is heard in a callback of the compiler, which swallows what is raised."""
    toy(tmp_path)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "kept")}
    call = [sys.executable, "-c", TOLD.format(folder=str(tmp_path)), sent]
    ended = subprocess.run(call, env=environment, check=False, capture_output=True, text=True)
    assert (ended.returncode in (130, 128 + getattr(signal, sent)), ended.stdout) == (True, "")


def toy(folder: Path) -> Path:
    """A module with a kernel; where that is kept."""
    source = "from elbowroom.jit import exact_kernel\n\n\n@exact_kernel\ndef double(x):\n    return 2.0 * x\n"
    (folder / "toy.py").write_text(source)
    return folder / "kept"


def compilations(folder: Path, **options: object) -> str:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(folder / "kept")}
    call = [sys.executable, "-c", PROGRAM.format(folder=str(folder))]
    return subprocess.run(call, env=environment, check=True, capture_output=True, text=True, **options).stdout.strip()  # type: ignore[call-overload,no-any-return]


@pytest.mark.long
def test_a_real_kernel_is_kept_checked_and_made_anew(tmp_path: Path) -> None:
    place = toy(tmp_path)
    assert compilations(tmp_path) == "1"
    assert compilations(tmp_path) == "0"
    name = name_of(tmp_path / "toy.py", "double", 4)
    (folder,) = {file.parent for file in place.rglob("*.sum")}
    (bitcode,) = folder.glob("*.bc")
    files = {f"{name}.nbi", f"{name}.1.nbc", bitcode.name, f"{name}.sum"}
    for damaged in (folder / f"{name}.1.nbc", bitcode):
        assert {file.name for file in folder.iterdir()} == files
        flip(damaged)
        assert compilations(tmp_path) == "1"
    assert compilations(tmp_path) == "0"
    bitcode.unlink()  # callers would take in a kernel that does nothing
    (folder / f"{name}.sum").unlink()
    assert compilations(tmp_path) == "1"


def test_kernels_run_uncompiled_too(tmp_path: Path) -> None:
    toy(tmp_path)
    call = [sys.executable, "-c", PROGRAM.format(folder=str(tmp_path)).replace("print(", "repr(lambda: ")]
    subprocess.run(call, env=os.environ | {"NUMBA_DISABLE_JIT": "1"}, check=True)


def test_a_program_whose_kernels_cannot_be_written_runs(tmp_path: Path) -> None:
    toy(tmp_path)
    most = 100  # bytes that a file may have
    assert compilations(tmp_path, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))) == "1"


def test_a_kernel_that_was_read_is_taken_in_by_one_that_is_compiled(
    tmp_path: Path,
) -> None:
    place = toy(tmp_path)
    assert compilations(tmp_path) == "1"
    caller = "from elbowroom.jit import exact_kernel\nfrom toy import double\n\n\n@exact_kernel\ndef fourfold(x):\n"
    (tmp_path / "caller.py").write_text(f"{caller}    return double(double(x))\n")
    program = f"""
import sys
sys.path.insert(0, {str(tmp_path)!r})
from toy import double
assert double(4.0) == 8.0
(found,) = double.overloads.values()
print(type(found.library._shared_module).__name__)
from caller import fourfold
assert fourfold(4.0) == 16.0
print(sum(double.stats.cache_misses.values()), sum(fourfold.stats.cache_misses.values()))
"""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(place)}
    call = [sys.executable, "-c", program]
    runs = [subprocess.run(call, env=environment, check=True, capture_output=True, text=True).stdout for _ in range(2)]
    assert [run.split() for run in runs] == [["UnreadModule", "0", "1"], ["UnreadModule", "0", "0"]]
