"""Kernels kept on disk: without machine code where only kernels call them, and their modules read only when needed."""

import subprocess
import sys
from pathlib import Path

KERNELS = """
import numpy as np
from elbowroom.jit import exact_inner_kernel, exact_kernel, exact_lean_kernel, kernel, leaf


@leaf
def one_more(number: float) -> float:
    return number + 1.0


@exact_lean_kernel
def add_to(numbers, what: float) -> None:
    for i in range(numbers.shape[0]):
        numbers[i] += one_more(what)


@exact_inner_kernel
def row(count: int, what: float):
    numbers = np.zeros(count)
    add_to(numbers, what)
    if count == 13:
        raise ValueError("unlucky")
    return numbers


@kernel
def total(count: int, what: float) -> float:
    return row(count, what).sum()


@exact_kernel
def twice(count: int, what: float) -> float:
    return 2.0 * total(count, what) + row(1, what)[0]
"""
TOLD = "import kernels; print(kernels.{0}(3, 1.0), sum(kernels.{0}.stats.cache_hits.values()))"
MODULES = "print(sum(bool(c.library.bitcode) for k in (kernels.total, kernels.row) for c in k.overloads.values()))"
KEPT = """
import pathlib, pickle
for file in pathlib.Path("__pycache__").glob("kernels.*.nbc"):
    (_, _, (machine_code, module)), *_ = pickle.loads(file.read_bytes())
    assert module.startswith(b"BC")
    print(file.name.split(".")[1].split("-")[0], bool(machine_code))
"""
UNLUCKY = """
import kernels
try:
    kernels.{0}(13, 1.0)
except ValueError as error:
    print(error)
"""


def run(folder: Path, program: str) -> str:
    """What a program says that can import the kernels, in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, check=True
    ).stdout.strip()


def test_only_what_python_calls_has_machine_code(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNELS)
    assert run(tmp_path, TOLD.format("twice")) == "14.0 0"
    told = dict(line.split() for line in run(tmp_path, KEPT).splitlines())
    assert told == {"twice": "True", "total": "True", "row": "False", "add_to": "False"}


def test_what_was_kept_does_the_same_and_its_module_stays_unread(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNELS)
    assert run(tmp_path, TOLD.format("total")) == "6.0 0"
    assert run(tmp_path, f"{TOLD.format('total')}; {MODULES}") == "6.0 1\n1"


def test_what_was_kept_is_linked_into_what_is_compiled_later(tmp_path: Path) -> None:
    """`total` and `row` are read from disk, and their modules when `twice` is compiled, which calls both."""
    (tmp_path / "kernels.py").write_text(KERNELS)
    assert run(tmp_path, TOLD.format("total")) == "6.0 0"
    assert run(tmp_path, f"{TOLD.format('twice')}; {MODULES}") == "14.0 0\n0"
    assert run(tmp_path, TOLD.format("twice")) == "14.0 1"


def test_errors_come_out_of_kernels_that_were_just_compiled_and_of_those_that_were_kept(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNELS)
    for _ in range(2):
        assert run(tmp_path, UNLUCKY.format("twice")) == "unlucky"
