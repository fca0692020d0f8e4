"""`elbowroom play` as a process of its own."""

import json
import socket
import subprocess
import sys
import time
import urllib.request
from types import TracebackType
from typing import Self

START_SECONDS = 600.0  # the first start compiles the kernels


class LiveServer:
    """A server on a free port of this machine; can be stopped and started again on the same port."""

    def __init__(self) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port: int = probe.getsockname()[1]
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    @property
    def pid(self) -> int:
        """Its process."""
        assert self._process is not None
        return self._process.pid

    def start(self) -> None:
        """Start it and wait until it answers."""
        command = [sys.executable, "-m", "elbowroom", "play", "--no-open", "--port", str(self.port)]
        self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + START_SECONDS
        while time.monotonic() < deadline and self._process.poll() is None:
            if self._answers():
                return
            time.sleep(0.1)
        raise RuntimeError(f"`{' '.join(command[1:])}` did not come up")

    def stop(self) -> None:
        """End it."""
        if self._process is not None:
            self._process.terminate()
            self._process.wait(timeout=20)
            self._process = None

    def get_json(self, path: str) -> dict[str, object]:
        """What the server answers at a path."""
        with urllib.request.urlopen(self.url + path, timeout=10) as response:
            data: dict[str, object] = json.load(response)
            return data

    def _answers(self) -> bool:
        try:
            return self.get_json("/api/health")["status"] == "ok"
        except OSError:
            return False

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()
