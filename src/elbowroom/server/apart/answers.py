"""What such a process answers: one byte that says how it went, then a text or what was made.

What was made travels as a pickle, but only our own records and plain arrays are taken out of it: a process that was
taken over by the file that it reads must not be able to have its server call anything.
"""

import dataclasses
import enum
import errno
import io
import pickle
from enum import Enum
from typing import Any

NO_SPACE = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})  # a full disk, a full share of one, a bound on files
_ROOMS = ("geometry", "formats", "body", "clips", "world")
_ARRAYS = {
    ("numpy", "dtype"),
    ("numpy", "ndarray"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy._core.multiarray", "scalar"),
    ("numpy._core.numeric", "_frombuffer"),
    ("builtins", "slice"),
}


class Outcome(Enum):
    """How the work went."""

    MADE = b"P"  # what was made follows
    WRONG = b"E"  # what came is wrong: a line for the user follows
    MEMORY = b"M"
    DISK = b"D"
    FAILED = b"X"  # a fault of ours: a traceback follows


def packed(value: object) -> bytes:
    """What was made, as bytes."""
    stream = io.BytesIO()
    _Plain(stream, protocol=5).dump(value)
    return stream.getvalue()


def unpacked(data: bytes) -> Any:
    """What `packed` wrote; raises `pickle.UnpicklingError` where it holds anything else than records and arrays."""
    try:
        return _OwnRecords(io.BytesIO(data)).load()
    except pickle.UnpicklingError:
        raise
    except Exception as error:
        raise pickle.UnpicklingError(f"no answer: {error}") from None


class _Plain(pickle.Pickler):
    def reducer_override(self, value: object) -> Any:
        """Members of enumerations by their value: some versions of Python write a call of `getattr` for them."""
        return (type(value), (value.value,)) if isinstance(value, Enum) else NotImplemented


class _OwnRecords(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        if (module, name) in _ARRAYS:
            return super().find_class(module, name)
        parts = module.split(".")
        if parts[0] == "elbowroom" and len(parts) > 2 and parts[1] in _ROOMS and name.isidentifier():
            found = super().find_class(module, name)
            if isinstance(found, type) and found.__module__ == module and _is_record(found):
                return found
        raise pickle.UnpicklingError(f"{module}.{name} is no record of ours")


def _is_record(kind: type) -> bool:
    named = issubclass(kind, tuple) and hasattr(kind, "_fields")
    return dataclasses.is_dataclass(kind) or issubclass(kind, enum.Enum) or named
