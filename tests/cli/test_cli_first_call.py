"""A first call: wrong arguments are told before anything heavy is imported, compilation is counted."""

import subprocess
import sys

import pytest

from elbowroom.cli.telling import first_run
from elbowroom.server.kernels import compiling, kernel_cache
from elbowroom.server.kernels.warmup import Report
from sampled import sampled

_CALL = """
import sys
from elbowroom.cli.main import run
sys.argv = ["elbowroom", *{arguments!r}]
try:
    run()
finally:
    assert "numba" not in sys.modules, "numba was imported"
"""


@pytest.mark.parametrize(
    ("call", "said"),
    sampled(
        [
            ("walk --scene nope", "'nope' is neither a stock scene"),
            ("walk --scene gauntlet:9:1", "level: 9"),
            ("walk --planner zzz", "planner 'zzz' is unknown"),
            ("walk --queue 99", "queue size: 99"),
            ("walk --avatar none.vrm", "none.vrm: cannot be read"),
            ("gauntlet --level 9", "level: 9"),
            ("gauntlet --planner zzz", "planner 'zzz' is unknown"),
            ("table1 --planner exact,zzz", "planner 'zzz' is unknown"),
            ("table1 --scenes a,nope", "'nope' is neither a stock scene"),
            ("table1 --queues 3,99", "queue size: 99"),
        ],
        4,
    ),
)
def test_wrong_arguments_are_told_before_numba_is_imported(call: str, said: str) -> None:
    program = [sys.executable, "-c", _CALL.format(arguments=call.split())]
    run = subprocess.run(program, capture_output=True, text=True, check=False)
    assert (run.returncode, len(run.stderr.splitlines())) == (2, 1), run.stderr
    assert said in run.stderr


def test_compiling_is_counted(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    total = len(kernel_cache.session_kernels())

    def compile_apart(report: Report) -> None:
        for number in range(total):
            report(f"kernel {number}", number)

    monkeypatch.setattr(kernel_cache, "is_warm", lambda: False)
    monkeypatch.setattr(compiling, "compile_apart", compile_apart)
    first_run.compile_first()
    told = capsys.readouterr().err
    assert f"Compiling kernels, once: 0 of {total}" in told
    assert f"{total} of {total}" in told
    first_run.compile_first(quiet=True)
    assert capsys.readouterr().err == ""


def test_what_is_compiled_is_not_told_again(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(compiling, "compile_apart", lambda _: pytest.fail("compiles again"))
    first_run.compile_first()
    assert capsys.readouterr().err == ""
