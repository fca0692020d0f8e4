"""`elbowroom play` and `elbowroom doctor`, as a user runs them."""

import json
import signal
import subprocess
import sys
from pathlib import Path
from urllib.request import urlopen

import pytest
from rich.console import Console
from typer.testing import CliRunner

from elbowroom.cli import play as play_module
from elbowroom.cli.main import app, run
from elbowroom.server.serving import listen

COMMAND = [sys.executable, "-c", "import sys; from elbowroom.cli import main; sys.argv[0] = 'elbowroom'; main()"]


def test_play_takes_the_next_port_serves_and_ends_with_ctrl_c(tmp_path: Path) -> None:
    words = tmp_path / "stderr.txt"
    with listen("127.0.0.1", 0) as taken, words.open("w") as stderr:
        port = taken.getsockname()[1]
        arguments = ["play", "--port", str(port), "--no-open", "--scene", "empty"]
        with subprocess.Popen([*COMMAND, *arguments], stdout=subprocess.PIPE, stderr=stderr, text=True) as server:
            assert server.stdout is not None
            line = server.stdout.readline()
            url = line.split()[3]
            assert urlopen(f"{url}/api/health", timeout=60).status == 200
            server.send_signal(signal.SIGINT)
            assert server.wait(60) == 0
    said = words.read_text()
    assert f"Port {port} is busy; using {url.rpartition(':')[2]} instead." in " ".join(said.split())
    assert "Traceback" not in said
    assert "Stopped." in said


@pytest.mark.parametrize(
    ("sent", "code"), [(signal.SIGINT, 0), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.long)]
)
def test_a_signal_ends_the_server_whatever_its_threads_do(sent: signal.Signals, code: int) -> None:
    """A thread that never ends, and one that is never done with its work."""
    program = """
import threading, time
from concurrent.futures import ThreadPoolExecutor
from elbowroom.cli import play
from elbowroom.server.stores.library import Library

def busy(library, url, open_page):
    threading.Thread(target=time.sleep, args=(1000,)).start()
    ThreadPoolExecutor(1).submit(lambda: [(sum(range(10**5)), time.sleep(0.01)) for _ in range(10**6)])
    print(library.avatars.folder, flush=True)

play.compile_first = lambda: None
play._ready = busy
play.serve_until_interrupted(lambda: Library.open("empty"), "127.0.0.1", 0, open_page=False)
"""
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        folder = Path(server.stdout.readline().strip())
        assert folder.is_dir()
        server.send_signal(sent)
        assert server.wait(20) == code
    assert not folder.exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--scene", "nowhere"], "nowhere"),
        (["--avatar", "missing.vrm"], "missing.vrm"),
        (["--planner", "magic"], "planner 'magic' is unknown"),
        (["--host", "203.0.113.7", "--port", "0"], "203.0.113.7"),
        (["--queue", "33"], "queue size: 33 is not a whole number from 2 to 32"),
        (["--queue", "1"], "queue size: 1 is not a whole number from 2 to 32"),
        (["--scene", "gauntlet"], "gauntlet:LEVEL:SEED"),
        (["--port", "70000"], "70000"),
    ],
)
def test_a_wrong_call_is_one_line_and_exit_code_2(
    arguments: list[str], said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["elbowroom", "play", "--no-open", "--port", "0", *arguments])
    with pytest.raises(SystemExit) as left:
        run()
    assert left.value.code == 2
    line = capsys.readouterr().err.strip()
    assert said in line
    assert "\n" not in line


def test_an_open_server_is_warned_about(capsys: pytest.CaptureFixture[str]) -> None:
    for host, warned in (("127.0.0.1", False), ("0.0.0.0", True)):
        with listen(host, 0) as opened:
            play_module.tell_openness(Console(stderr=True), opened)
        assert ("no password" in " ".join(capsys.readouterr().err.split())) is warned


def test_the_browser_is_opened_only_where_there_is_a_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert not play_module._has_display()
    monkeypatch.setenv("WAYLAND_DISPLAY", "wayland-0")
    assert play_module._has_display()


@pytest.mark.long
def test_doctor_measures_a_live_session() -> None:
    result = subprocess.run(
        [*COMMAND, "doctor", "--session", "--seconds", "2", "--json"], check=False, capture_output=True, text=True
    )
    facts = json.loads(result.stdout)
    assert result.returncode == (1 if facts["faults"] else 0)
    assert 10 < facts["kernels"]["kept"] <= facts["kernels"]["known"]
    assert facts["processor"]["vector_bits"] >= 128
    assert all(facts["packages"].values())
    session = facts["session"]
    assert session["cpu_percent"] > 0.0
    assert 50.0 < session["own_megabytes"] < session["resident_megabytes"]
    told = any("more memory than its budget" in fault for fault in facts["faults"])
    assert told is (session["own_megabytes"] > session["own_budget_megabytes"])
    assert session["frames_per_second"] > 1.0


def test_doctor_as_text() -> None:
    result = CliRunner().invoke(app, ["doctor"])
    for word in ("elbowroom", "numba", "cores", "kernels", "wheel"):
        assert word in result.stdout
    assert result.exit_code in (0, 1)
    assert (result.exit_code == 1) == ("fault" in result.stdout)
