"""The bytes of a file that somebody named, if it is there and of sane size."""

from pathlib import Path

from elbowroom.errors import InputError


def read_file(path: Path, most: int) -> bytes:
    """The bytes of a file that has at most `most`; raises `InputError`."""
    try:
        size = path.stat().st_size
        data = path.read_bytes() if size <= most else b""
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except ValueError:
        raise InputError(f"{str(path)!r} is not a file name") from None
    if size > most:
        raise InputError(f"{path}: has {size >> 20} MB: at most {most >> 20} MB are read")
    return data
