"""There is a place for compiled kernels, or a word that there is none."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from elbowroom.server.kernels import kernel_files


def test_a_full_or_missing_place_gives_way_to_a_private_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel_files.tempfile, "gettempdir", lambda: str(tmp_path))  # type: ignore[attr-defined]
    private = tmp_path / f"elbowroom-kernels-{os.getuid()}"
    monkeypatch.setenv("NUMBA_CACHE_DIR", "/proc/nowhere")
    told = kernel_files.find_place()
    assert "/proc/nowhere" in str(told)
    assert str(private) in str(told)
    assert os.environ["NUMBA_CACHE_DIR"] == str(private)
    assert private.stat().st_mode & 0o777 == 0o700
    assert kernel_files.find_place() is None  # and is good now

    monkeypatch.setenv("NUMBA_CACHE_DIR", "/proc/nowhere")
    private.chmod(0o777)  # somebody else may have put something there
    assert "every start compiles them anew" in str(kernel_files.find_place())


@pytest.mark.parametrize(
    ("folders", "said"),
    [
        (["/one"], "cannot be kept in /one"),
        (["/one", "/two"], "can be kept neither in /one nor in /two"),
    ],
)
@pytest.mark.parametrize("private", [True, False])
def test_what_is_told_is_a_sentence_of_one_folder_or_of_two(
    folders: list[str], said: str, *, private: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    monkeypatch.setattr(kernel_files, "places", lambda: [Path(folder) for folder in folders])
    monkeypatch.setattr(kernel_files, "_private_folder", lambda: tmp_path if private else None)
    monkeypatch.setattr(kernel_files, "_has_room", lambda folder: folder == tmp_path)
    place = f"they go to {tmp_path}; set NUMBA_CACHE_DIR for another place"
    none = "every start compiles them anew; set NUMBA_CACHE_DIR"
    assert kernel_files.find_place() == f"compiled kernels {said}: {place if private else none}"


def test_a_full_disk_gives_way_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert kernel_files.find_place() is None
    monkeypatch.setattr(kernel_files, "NEEDED", 2**60)
    assert "every start compiles them anew" in str(kernel_files.find_place())


def test_a_program_without_any_place_runs_and_says_so_in_one_line(tmp_path: Path) -> None:
    """As in a container with a read-only package, no home and nothing to write to."""
    environment = os.environ | {"NUMBA_CACHE_DIR": "/proc/nowhere", "TMPDIR": "/proc/nowhere", "HOME": "/proc/nowhere"}
    program = (
        "import tempfile; tempfile.tempdir = '/proc/nowhere'\n"
        "import sys; sys.argv = ['elbowroom', 'walk', '--scene', 'nowhere']\n"
        "from elbowroom.cli.main import run\n"
        "from elbowroom.jit import exact_kernel\n"
        "run()\n"
    )
    ran = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=False)
    first, second = ran.stderr.strip().splitlines()
    assert first.startswith("elbowroom: compiled kernels cannot be kept in /proc/nowhere: every start compiles")
    assert "nowhere" in second
    assert ran.returncode == 2
