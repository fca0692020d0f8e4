"""Files that somebody named: the bytes of one that is there and of sane size, and what one to come may be called."""

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


def check_ending(path: str | Path | None, what: str, *endings: str) -> None:
    """Raises `InputError` where a file to come is not called as what it will hold: a slip would replace another one."""
    if path is not None and Path(path).suffix.lower() not in endings:
        raise InputError(f"{path}: {what} is written there: its name must end with {endings[0]}")
