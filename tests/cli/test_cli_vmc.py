"""`elbowroom walk --vmc`: what is walked is sent, in time."""

import json
import socket
from pathlib import Path

from pythonosc.osc_bundle import OscBundle
from typer.testing import CliRunner

from elbowroom.cli.main import app

SCENE = {
    "format": "elbowroom-scene",
    "version": 1,
    "name": "step",
    "title": "A step",
    "description": "Hardly any way.",
    "ground": {"size": [6, 6], "center": [0, 0]},
    "start": {"position": [0, 0], "heading": 0},
    "finish": {"position": [0, 0.4], "heading": 0},
    "obstacles": [],
}


def test_a_walk_is_sent_frame_by_frame(tmp_path: Path) -> None:
    scene = tmp_path / "step.json"
    scene.write_text(json.dumps(SCENE))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{receiver.getsockname()[1]}"
        result = CliRunner().invoke(app, ["walk", "--scene", str(scene), "--vmc", address, "--json", "-q"])
        assert result.exit_code == 0, result.output
        receiver.setblocking(False)
        times = []
        try:
            while True:
                contents = list(OscBundle(receiver.recv(65536)))
                times += [message.params[0] for message in contents if message.address == "/VMC/Ext/T"]
        except BlockingIOError:
            pass
    assert len(times) > 3  # what the system's buffer held of it
    assert times == sorted(times)


def test_a_wrong_address_is_one_line_and_2() -> None:
    result = CliRunner().invoke(app, ["walk", "--vmc", "somewhere:0"])
    assert result.exit_code == 2
    assert result.stderr == "elbowroom: vmc: 'somewhere:0' is no address: HOST:PORT with a port from 1 to 65535\n"
