"""The first start: a few processes compile, each kernel is told once, and a failure costs only time."""

import ast
import gc
import itertools
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numba
import pytest

import elbowroom
from elbowroom.cli.bench.compile import compiled_in
from elbowroom.jit import kernels_made
from elbowroom.server.kernels import compiling, kernel_cache
from elbowroom.server.kernels.compiling import PIECES, command, compile_all, compile_apart, processes
from sources import COMPILED

PACKAGE = Path(elbowroom.__file__).parent


def _working(monkeypatch: pytest.MonkeyPatch, *bodies: str) -> None:
    """Have other programs run than compilers, one after the other: what each does with a `piece`."""
    programs = itertools.cycle(bodies)

    def program() -> list[str]:
        body = "\n ".join([*next(programs).split("; "), "print(flush=True)"])
        return [sys.executable, "-c", f"import os, sys\nfor piece in map(str.strip, sys.stdin):\n {body}"]

    monkeypatch.setattr(compiling, "command", program)
    monkeypatch.setattr(compiling, "processes", lambda: len(bodies))


def test_every_piece_is_compiled_once_and_every_kernel_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    _working(monkeypatch, "print(piece); print('both')", "print('both'); print(piece)")
    heard: list[tuple[str, int]] = []
    assert compile_all(lambda kernel, number: heard.append((kernel, number)), os.environ)
    assert sorted(kernel for kernel, _ in heard) == sorted(["both", *PIECES])
    assert [number for _, number in heard] == list(range(len(PIECES) + 1))


@pytest.mark.parametrize("ends", ["raise SystemExit(3)", "os.abort()"])
def test_a_process_that_fails_leaves_the_rest_to_others_and_no_mark(monkeypatch: pytest.MonkeyPatch, ends: str) -> None:
    _working(monkeypatch, f"print('a', flush=True); {ends}", "print(piece)")
    marks: list[bool] = []
    monkeypatch.setattr(compiling, "is_warm", lambda: False)
    monkeypatch.setattr(compiling, "mark_warm", lambda: marks.append(True))
    heard: set[str] = set()
    compile_apart(lambda kernel, number: heard.add(kernel))
    assert len(heard - {"a"}) >= len(PIECES) - 1
    assert marks == []
    _working(monkeypatch, "print('a')", "print('b')")
    compile_apart(lambda kernel, number: None)
    assert marks == [True]


def test_there_are_as_many_processes_as_processors_but_a_few_at_most(monkeypatch: pytest.MonkeyPatch) -> None:
    for there, expected in ((1, 1), (2, 2), (64, 4)):
        monkeypatch.setattr(os, "sched_getaffinity", lambda _, there=there: set(range(there)))
        assert processes() == expected


def test_nothing_to_compile_starts_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiling, "is_warm", lambda: True)
    monkeypatch.setattr(compiling, "compile_all", lambda *_: pytest.fail("compiles again"))
    compile_apart(lambda kernel, number: None)


def test_a_few_changed_files_are_compiled_where_they_are_needed_and_many_ahead() -> None:
    def mark(changed: int, compiler: str = "1.0") -> dict[str, Any]:
        return {"compiler": [compiler], "sources": {f"{n}.py": "new" if n < changed else "old" for n in range(60)}}

    assert kernel_cache.is_nearly(mark(0), mark(0))
    assert kernel_cache.is_nearly(mark(0), mark(5))
    assert not kernel_cache.is_nearly(mark(0), mark(40))
    assert not kernel_cache.is_nearly(mark(0), mark(0, "2.0"))
    nothings: tuple[Any, ...] = ({}, [], None, 3, {"compiler": ["1.0"], "sources": 3})
    for nonsense in nothings:
        assert not kernel_cache.is_nearly(nonsense, mark(0))


def test_the_processes_get_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    _working(monkeypatch, "print(os.environ['NUMBA_CACHE_DIR'])")
    heard: list[str] = []
    compile_all(lambda kernel, number: heard.append(kernel), os.environ | {"NUMBA_CACHE_DIR": "there"})
    assert heard == ["there"]


_OPEN = """
from elbowroom.server.stores.library import Library
from elbowroom.server.kernels.warmup import first_steps, listening, warm_up
with listening(lambda kernel, number: print(kernel)):
    library = Library.open("traffic")
"""
_START = f"""
{_OPEN}
    first_steps(library)
    warm_up(library)
"""


def _compiles(program: str, cache: Path) -> list[str]:
    """The kernels which a program must compile that keeps them in `cache`."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    run = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    return run.stdout.split()


def test_files_are_read_before_anything_is_compiled(tmp_path: Path) -> None:
    assert _compiles(_OPEN, tmp_path) == []


@pytest.mark.long
def test_the_pieces_leave_the_server_nothing_to_compile(tmp_path: Path) -> None:
    assert compile_all(lambda kernel, number: None, os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)})
    assert _compiles(_START, tmp_path) == []


@pytest.mark.long
def test_a_process_compiles_what_it_is_told_and_says_when_it_is_done() -> None:
    told = subprocess.run(command(), input="product\n", capture_output=True, text=True, check=False).stdout
    assert told.endswith("\n")
    assert set(told.split()) <= {
        f"{kernel.__module__.removeprefix('elbowroom.')}.{kernel.__name__}" for kernel in kernels_made()
    }


def test_kernels_of_other_rooms_than_a_sessions_are_left_out() -> None:
    kernels = kernel_cache.session_kernels()
    assert len(kernels) > 100
    assert {kernel.__module__.split(".")[1] for kernel in kernels} <= {
        "body",
        "world",
        "planning",
        "control",
        "clips",
        "held",
    }


def test_kernels_are_known_beside_functions_of_no_module_and_when_all_is_taken_for_lasting() -> None:
    scope: dict[str, Any] = {}
    exec("def of_no_module(number):\n    return number", scope)
    nobodys = numba.njit(scope["of_no_module"])
    assert nobodys.__module__ is None
    known = kernel_cache.kernels()
    assert nobodys not in known
    gc.freeze()
    try:
        assert kernel_cache.kernels() == known
        assert kernel_cache.cache_folders()
    finally:
        gc.unfreeze()


def test_compiled_files_are_counted_by_kernel(tmp_path: Path) -> None:
    for name in ("proof.limb_way-9.py311.1.nbc", "proof.limb_way-9.py311.2.nbc", "slots.find-4.py311.1.nbc"):
        (tmp_path / name).touch()
    (tmp_path / "slots.find-4.py311.nbi").touch()
    assert compiled_in(tmp_path) == {"proof.limb_way": 2, "slots.find": 1}


LIVE = "body", "clips", "control", "planning", "world"  # rooms that a session and its readers work in
SELDOM = {"touching"}  # files of these that benchmarks alone work with
REHEARSED = """
from elbowroom.jit import kernels_made
from elbowroom.server.kernels.compiling import PIECES, compile_piece
from elbowroom.server.stores.library import Library
library = Library.open()
for piece in PIECES:
    compile_piece(piece, library)
for made in kernels_made():
    if made.stats.cache_hits or made.stats.cache_misses:
        print(f"{made.py_func.__module__}.{made.py_func.__qualname__}")
"""


def entered(path: Path) -> tuple[set[str], set[str]]:
    """The kernels that a file's plain functions call by name, and those that its compiled ones do."""
    module = import_module(".".join(("elbowroom", *path.relative_to(PACKAGE).with_suffix("").parts)))
    made = {id(one): f"{one.py_func.__module__}.{one.py_func.__qualname__}" for one in kernels_made()}
    plain, compiled = set[str](), set[str]()
    for function in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(function, ast.FunctionDef):
            marks = {mark.id for mark in function.decorator_list if isinstance(mark, ast.Name)}
            calls = [node.func for node in ast.walk(function) if isinstance(node, ast.Call)]
            called = [getattr(module, call.id, None) for call in calls if isinstance(call, ast.Name)]
            names = {made[id(one)] for one in called if id(one) in made}
            (compiled if marks & COMPILED else plain).update(names)
    return plain, compiled


def test_no_kernel_is_left_to_be_compiled_while_somebody_plays() -> None:
    """Each that Python enters is entered once by the compilers, or is compiled with one that calls it."""
    files = [path for room in LIVE for path in sorted((PACKAGE / room).rglob("*.py")) if path.stem not in SELDOM]
    found = [entered(path) for path in files]
    entries, within = (set[str]().union(*(one[side] for one in found)) for side in range(2))
    run = subprocess.run([sys.executable, "-c", REHEARSED], check=True, capture_output=True, text=True)
    rehearsed = set(run.stdout.split())
    assert len(rehearsed) > 100
    assert sorted(entries - within - rehearsed) == []
