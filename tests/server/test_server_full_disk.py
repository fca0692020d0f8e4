"""A full disk, or a bound on files, under a running server: uploads are refused, nothing else is harmed."""

import json
import resource
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from elbowroom.body.stock import stock_avatar_path
from live_server import LiveServer


def sent(server: LiveServer, file: Path) -> tuple[int, dict[str, object]]:
    """Upload an avatar as the page does: the status, and what is said."""
    headers = {"origin": server.url, "content-type": "application/octet-stream"}
    asked = urllib.request.Request(f"{server.url}/api/avatars?name=mine.vrm", file.read_bytes(), headers)
    try:
        with urllib.request.urlopen(asked, timeout=300) as answer:
            return answer.status, json.load(answer)
    except urllib.error.HTTPError as refusal:
        return refusal.code, json.load(refusal)


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="bounds of another process are set on Linux only")
def test_a_server_without_room_refuses_files_and_takes_them_again_when_there_is() -> None:
    avatar = stock_avatar_path()
    with LiveServer() as server:
        before = resource.prlimit(server.pid, resource.RLIMIT_FSIZE)
        resource.prlimit(server.pid, resource.RLIMIT_FSIZE, (avatar.stat().st_size // 2, before[1]))
        status, said = sent(server, avatar)
        assert (status, "no space" in str(said["error"])) == (507, True)
        assert server.get_json("/api/health")["status"] == "ok"
        resource.prlimit(server.pid, resource.RLIMIT_FSIZE, before)
        assert sent(server, avatar)[0] == 201
