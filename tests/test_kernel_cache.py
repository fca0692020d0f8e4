"""Kernels kept on disk are forgotten when anything that was compiled into them has changed."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from elbowroom import kernel_cache
from elbowroom.planning.exact.group import search as group_search

SOURCES = {
    "__init__.py": "",
    "low/__init__.py": "",
    "low/constants.py": "SIZE = 3\n",
    "low/numbers.py": "from toy.low.constants import SIZE\n\n\ndef number():\n    return SIZE\n",
    "high/__init__.py": "",
    "high/user.py": "import os\nfrom toy.low import (\n    numbers,\n)\n",
    "high/other.py": "import toy.high.user\n",
    "high/alone.py": "from numpy import array\n",
}


def made(folder: Path) -> Path:
    package = folder / "toy"
    for name, text in SOURCES.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
    return package


def digests(package: Path) -> dict[str, str]:
    for kept in (kernel_cache.digest_of, kernel_cache._imported, kernel_cache._file, kernel_cache._line):
        kept.cache_clear()
    return {name: kernel_cache.digest_of(package / name, package) for name in SOURCES}


def test_a_change_reaches_all_that_import_it_and_nothing_else(tmp_path: Path) -> None:
    package = made(tmp_path)
    before = digests(package)
    assert digests(package) == before
    (package / "low/constants.py").write_text("SIZE = 4\n")
    after = digests(package)
    changed = {name for name in SOURCES if before[name] != after[name]}
    assert changed == {"low/constants.py", "low/numbers.py", "high/user.py", "high/other.py"}


def test_the_place_of_the_package_says_nothing(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    assert digests(made(tmp_path / "a")) == digests(made(tmp_path / "b"))


def test_a_kernel_knows_what_it_calls() -> None:
    sources = kernel_cache.sources_of(Path(group_search.__file__))
    names = {str(path.relative_to(kernel_cache.PACKAGE).as_posix()) for path in sources}
    assert {
        "planning/exact/lattice/lattice.py",
        "planning/exact/group/node_costs.py",
        "planning/model/limb.py",
        "jit.py",
    } <= names
    assert not {name for name in names if name.startswith(("control/", "server/", "cli/"))}


@pytest.mark.long
def test_a_kernel_that_is_kept_is_compiled_anew_when_a_constant_elsewhere_has_changed(tmp_path: Path) -> None:
    """The toy package takes the place of ours, so that its kernels are stamped as ours are."""
    package = made(tmp_path)
    (package / "high/user.py").write_text(
        "import elbowroom.kernel_cache as sources\n"
        "sources.digest_of.__wrapped__.__defaults__ = (sources.Path(__file__).parents[1],)\n"
        "from elbowroom.jit import exact_kernel\n"
        "from toy.low.constants import SIZE\n\n\n"
        "@exact_kernel\ndef size() -> int:\n    return SIZE\n\n\n"
        "print(size(), sum(size.stats.cache_hits.values()))\n"
    )

    def run() -> str:
        call = [sys.executable, "-c", "import toy.high.user"]
        own = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kept")}  # of this test alone
        return subprocess.run(call, cwd=tmp_path, env=own, capture_output=True, text=True, check=True).stdout.strip()

    assert run() == "3 0"
    assert run() == "3 1"
    (package / "low/constants.py").write_text("SIZE = 4\n")
    assert run() == "4 0"
