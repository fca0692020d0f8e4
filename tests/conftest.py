import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

sys.path.insert(0, str(Path(__file__).parent))

# On a busy machine an example may take seconds: how long things take is measured by benchmarks, not by tests.
settings.register_profile("calm", max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("calm")


@pytest.fixture(autouse=True, scope="session")
def _kernels_are_compiled_where_they_are_needed() -> None:
    """Commands that run within the tests' own process start no compilers: a test uses few of the kernels."""
    from elbowroom.server.kernels import kernel_cache

    kernel_cache.is_warm = lambda: True


@pytest.fixture(autouse=True, scope="session")
def _arrays_are_whole_where_kernels_take_them() -> Iterator[None]:
    """To Numba an array with gaps (a column, every second row) is another type: all are compiled once more for it.

    A user would wait for that, up to half a minute, in the middle of a walk. Told after the last test.
    """
    yield
    from elbowroom.jit import kernels_made

    named = [(kernel.__name__, " ".join(map(str, types))) for kernel in kernels_made() for types in kernel.overloads]
    assert [name for name, types in named if ", A)" in types] == [], "who calls them makes arrays contiguous first"
