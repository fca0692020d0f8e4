"""What lies in a dataset's folder: its spec, its files with their sums, the walks that were left out and why."""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from elbowroom import __version__
from elbowroom.dataset.spec import DatasetSpec
from elbowroom.errors import InputError
from elbowroom.experiment.machine import program_digest

FORMAT, VERSION = "elbowroom-dataset", 2
FILE = "manifest.json"


@dataclass(frozen=True)
class Written:
    """One file."""

    file: str
    first: int  # walk
    end: int  # one past the last
    sha256: str
    bytes: int
    walks: int  # that are in it
    seconds: float  # of motion
    rejected: dict[str, str] = field(default_factory=dict)  # numbers of walks that are not, and why


@dataclass(frozen=True)
class Manifest:
    """The whole folder."""

    spec: DatasetSpec
    shards: tuple[Written, ...] = ()
    made_with: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def new(cls, spec: DatasetSpec) -> "Manifest":
        """Of a folder with nothing in it yet."""
        from elbowroom.control.recordings.recording import this_machine  # slow to import, and not needed to read one

        return cls(spec, (), {"version": __version__, "program": program_digest(), "machine": this_machine()})

    @classmethod
    def load(cls, folder: Path) -> "Manifest | None":
        """That of a folder, None where there is none; raises `InputError` where it is damaged."""
        path = folder / FILE
        if not path.exists():
            return None
        try:
            given = json.loads(path.read_text("utf-8"))
            if given["format"] != FORMAT or given["version"] != VERSION:
                raise InputError(f"{path}: is no manifest of a dataset of walks, version {VERSION}")
            shards = tuple(Written(**entry) for entry in given["shards"])
            return cls(DatasetSpec.of(given["spec"]), shards, given["made_with"])
        except InputError:
            raise
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            raise InputError(f"{path}: is damaged; move it away to begin anew") from None

    @classmethod
    def of(cls, folder: Path) -> "Manifest":
        """That of a folder; raises `InputError` where there is none, or where it is damaged."""
        manifest = cls.load(folder)
        if manifest is None:
            raise InputError(f"{folder}: holds no dataset (no {FILE})")
        return manifest

    def why_left_out(self, walk: int) -> str | None:
        """Why a walk is in none of the files; None of one that is in one, or that nobody has made yet."""
        return next((row.rejected[str(walk)] for row in self.shards if str(walk) in row.rejected), None)

    def save(self, folder: Path) -> None:
        """Write it, whole or not at all."""
        path, part = folder / FILE, folder / f".{FILE}.part"
        document = {"format": FORMAT, "version": VERSION, **asdict(self)}
        try:
            part.write_text(json.dumps(document, indent=1, sort_keys=True) + "\n", "utf-8")
            part.replace(path)
        except OSError as error:
            raise InputError(f"{path}: cannot be written ({error.strerror})") from None
