"""A file to which every finished trial is appended, so that an interrupted experiment goes on where it was."""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from elbowroom.errors import InputError

FORMAT = "elbowroom-trials"
Record = dict[str, Any]


class TrialLog:
    """The finished trials of one experiment, by key; a context manager.

    The file is JSON lines: a header with the settings, then one line for each trial. Its name carries a hash of the
    settings, so trials made with other settings lie in a file of their own beside it. It is only ever appended to, and
    a line that was cut off is skipped. Raises `InputError` where the folder cannot be written or holds a foreign file.
    """

    def __init__(self, folder: Path, settings: Mapping[str, Any]) -> None:
        self.path = folder / f"trials-{digest(settings)[:12]}.jsonl"
        self.done: dict[str, Record] = {}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self.others = sum(1 for path in folder.glob("trials-*.jsonl") if path != self.path)
            before = self.path.read_bytes() if self.path.exists() else b""
            self._file = self.path.open("ab")
        except OSError as error:
            raise InputError(f"{error.filename or folder}: cannot be written ({error.strerror})") from None
        if not before:
            self._write({"format": FORMAT, "version": 1, "settings": settings})
            return
        self._read(before)
        if not before.endswith(b"\n"):
            self._file.write(b"\n")

    def _read(self, data: bytes) -> None:
        header, *lines = data.split(b"\n")
        if _parsed(header).get("format") != FORMAT:
            self._file.close()
            raise InputError(f"{self.path}: is no log of trials; move it away")
        for line in lines:
            entry = _parsed(line)
            if isinstance(entry.get("key"), str) and isinstance(entry.get("record"), dict):
                self.done.setdefault(entry["key"], entry["record"])

    def append(self, key: str, record: Record) -> None:
        """Keep a finished trial: it is in the file before this returns."""
        self.done[key] = record
        self._write({"key": key, "record": record})

    def _write(self, entry: Mapping[str, Any]) -> None:
        try:
            self._file.write(json.dumps(entry, separators=(",", ":")).encode() + b"\n")
            self._file.flush()
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written ({error.strerror})") from None

    def __enter__(self) -> "TrialLog":
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def digest(value: Any) -> str:
    """A hash of plain data: equal data, equal hash, on every machine."""
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def _parsed(line: bytes) -> dict[str, Any]:
    try:
        value = json.loads(line)
    except (ValueError, RecursionError):
        return {}
    return value if isinstance(value, dict) else {}
