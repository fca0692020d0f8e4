import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

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


_SELDOM = {"limb_sweep", "_spanned"}  # by tests alone; once for a place


@pytest.fixture(autouse=True, scope="session")
def _references_are_handed_over_by_themselves() -> Iterator[None]:
    """Of a usual tuple that holds one by reference Numba asks in Python what it is, at each call: for a tenth of a
    millisecond. Told after the last test.
    """
    yield
    from numba.core.types import BaseTuple

    from elbowroom.by_reference import Reference
    from elbowroom.jit import kernels_made

    def holds_one(kind: Any) -> bool:
        fields = getattr(kind, "types", ()) if isinstance(kind, BaseTuple) else ()
        return any(isinstance(field, Reference) or holds_one(field) for field in fields)

    entered = [kernel for kernel in kernels_made() if not kernel.targetoptions.get("no_cpython_wrapper")]
    named = {kernel.__name__ for kernel in entered for types in kernel.overloads if any(map(holds_one, types))}
    assert named <= _SELDOM, "the tuple that holds it is made one by reference too"
