"""Compiled kernels on disk: damaged ones go, and there is a place for them, or a word that there is none."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from elbowroom.server import kernel_files
from elbowroom.server.kernel_files import Place


def kept(folder: Path, count: int = 5) -> list[Path]:
    """As Numba leaves them."""
    (folder / "limb_12").mkdir(parents=True)
    files = [folder / "limb_12" / f"limb.pose-{number}.py311.1.nbc" for number in range(count)]
    for number, file in enumerate(files):
        file.write_bytes(bytes([number]) * 1000)
    return files


def flip(file: Path) -> None:
    data = bytearray(file.read_bytes())
    data[500] ^= 1
    before = file.stat()
    file.write_bytes(data)
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))


def test_a_flipped_byte_is_found_and_its_file_removed(tmp_path: Path) -> None:
    files, place = kept(tmp_path), Place(tmp_path)
    assert place.check() == []
    assert place.check() == []
    flip(files[2])
    assert place.check() == [files[2]]
    assert not files[2].exists()
    assert place.check() == []


def test_what_is_compiled_meanwhile_is_noted_down(tmp_path: Path) -> None:
    files, place = kept(tmp_path), Place(tmp_path)
    place.check()
    files[0].write_bytes(b"anew")
    new = files[0].with_suffix(".nbi")
    new.write_bytes(b"index")
    place.note()
    assert place.check() == []
    flip(kept(tmp_path / "more")[0])
    assert place.check() == []  # not known before
    flip(files[0].with_name(files[1].name))
    assert place.check() == [files[1]]


@pytest.mark.parametrize("damage", [b"", b"{", b"[]", b'{"a": 1}', b'{"a": ["x"]}', b"\xff"])
def test_a_damaged_list_is_made_anew(tmp_path: Path, damage: bytes) -> None:
    files, place = kept(tmp_path), Place(tmp_path)
    place.check()
    next(tmp_path.glob("*.sums")).write_bytes(damage)
    assert place.check() == []
    flip(files[0])
    assert place.check() == [files[0]]


def test_a_copy_of_the_folder_is_good(tmp_path: Path) -> None:
    import shutil

    files = kept(tmp_path / "one")
    Place(tmp_path / "one").check()
    shutil.copytree(tmp_path / "one", tmp_path / "two")
    flip(tmp_path / "two" / files[0].relative_to(tmp_path / "one"))
    assert len(Place(tmp_path / "two").check()) == 1


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
    assert first.startswith("elbowroom: compiled kernels can be kept neither in /proc/nowhere: every start compiles")
    assert "nowhere" in second
    assert ran.returncode == 2
