"""The motion as a Virtual Motion Capture receiver gets it: vmcp reads it, and puts every joint where the page does."""

import json
import math
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pythonosc.osc_bundle import OscBundle
from pythonosc.osc_message import OscMessage

from avatar_builder import Recipe, build
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.errors import InputError
from elbowroom.export.animation import Animation
from elbowroom.geometry import quaternion
from elbowroom.server.stores.library import Library
from elbowroom.server.vmc.protocol import Message, Puppet, VmcMoment, blink, messages, unity_name
from elbowroom.server.vmc.settings import Locomotion, VmcSettings
from elbowroom.server.vmc.stream import VmcStream, packets
from elbowroom.server.wire.pose import Poser
from godot_judge import GodotJudge
from live_session import client_of, running

Floats = NDArray[np.float64]

STOCK = Humanoid.default()
JUDGE = Path(__file__).parents[1] / "vmc_judge.py"
RECIPES = {
    "VRM 1.0, turned nodes": Recipe(vrm="1", spin=True, mesh=False),
    "VRM 0.x": Recipe(vrm="0", heading=np.pi, mesh=False),
    "VRM 0.x, turned nodes": Recipe(vrm="0", heading=np.pi, spin=True, mesh=False),
}


@cache
def body(name: str) -> Humanoid:
    return STOCK if name == "stock" else load_humanoid_bytes(build(RECIPES[name]), "made.vrm")


def posed(humanoid: Humanoid, seed: int = 0) -> tuple[VmcMoment, Floats]:
    """A random pose somewhere in the world, and where its joints (J, 3) are there."""
    rng = np.random.default_rng(seed)
    rotations = quaternion.from_rotation_vector(0.5 * rng.normal(size=(len(humanoid.skeleton.names), 3)))
    hips = humanoid.skeleton.positions[0] + 0.2 * rng.normal(size=3)
    place, heading = rng.normal(size=3), float(rng.uniform(-6.0, 6.0))
    moment = VmcMoment(1.5, tuple(place.tolist()), heading, Poser(humanoid).full_pose(rotations, hips))
    world = Animation("made", 60.0, humanoid.skeleton, rotations[None], hips[None], place[None], np.array([heading]))
    return moment, world.joints_in_world()[0]


def in_unity(told: list[Message], humanoid: Humanoid) -> Floats:
    """Joints (J, 3) as a receiver places them that has loaded the same file, in Unity's world.

    The file's nodes above the hips stand as its importer puts them: mirrored along X, or along Z where it faces -Z.
    """
    roots = {address: values for address, values in told if "Root" in address}
    (root,) = roots.values()
    bones = [values for address, values in told if "Bone" in address]
    rig, parents = humanoid.rig, humanoid.skeleton.parents
    assert rig is not None
    mirror = np.array([1.0, 1.0, -1.0] if abs(rig.facing) > 1.0 else [-1.0, 1.0, 1.0])
    above = rig.hips_parent_rotation * np.append(-mirror, 1.0)
    stand = mirror * (rig.hips_parent_position - rig.offset)
    places, turns = np.empty((len(bones), 3)), np.empty((len(bones), 4))
    for joint, (_, *numbers) in enumerate(bones):
        at, turned = np.array(numbers[:3]), np.array(numbers[3:])
        before, origin = (above, stand) if parents[joint] < 0 else (turns[parents[joint]], places[parents[joint]])
        places[joint] = origin + quaternion.rotate(before, at)
        turns[joint] = quaternion.multiply(before, turned)
    return np.array(root[1:4]) + quaternion.rotate(np.array(root[4:8]), places)


@pytest.mark.parametrize("locomotion", Locomotion)
@pytest.mark.parametrize("name", ["stock", *RECIPES])
def test_a_receiver_puts_every_joint_where_the_page_does(name: str, locomotion: Locomotion) -> None:
    humanoid = body(name)
    moment, joints = posed(humanoid)
    found = in_unity(list(messages(Puppet.of(humanoid), moment, locomotion)), humanoid)
    np.testing.assert_allclose(found, joints * [-1.0, 1.0, 1.0], atol=1e-5)


def test_all_that_the_protocol_asks_for_is_sent_every_frame() -> None:
    told = list(messages(Puppet.of(STOCK), posed(STOCK)[0]))
    assert told[0] == ("/VMC/Ext/OK", (1, 3, 0))
    assert told[1] == ("/VMC/Ext/T", (1.5,))
    assert [values[0] for address, values in told if "Root" in address] == ["root"]
    bones = {values[0]: np.array(values[1:]) for address, values in told if "Bone" in address}
    assert len(bones) == len(STOCK.skeleton.names)
    assert {
        "Hips",
        "LeftThumbProximal",
        "LeftThumbIntermediate",
        "LeftThumbDistal",
        "RightLittleDistal",
    } <= bones.keys()
    assert all(np.linalg.norm(numbers[:3]) > 1e-3 for numbers in bones.values())  # never a bone at its parent's place
    assert [address for address, _ in told[-2:]] == ["/VMC/Ext/Blend/Val", "/VMC/Ext/Blend/Apply"]


def test_eyes_close_and_open_again() -> None:
    closed = np.array([blink(time) for time in np.arange(0.0, 8.0, 0.005)])
    assert closed.min() == 0.0  # exactly open
    assert closed.max() > 0.9
    assert np.mean(closed > 0.0) < 0.1
    assert np.abs(np.diff(closed)).max() < 0.1


@pytest.mark.parametrize("bundles", [True, False])
def test_packets_fit_and_are_the_same_every_frame(bundles: bool) -> None:
    sizes = set()
    for seed in range(5):
        told = list(messages(Puppet.of(STOCK), posed(STOCK, seed)[0]))
        sent = list(packets(iter(told), bundles=bundles))
        assert max(map(len, sent)) <= 1400
        again = [message for packet in sent for message in _read(packet)]
        assert [(message.address, len(message.params)) for message in again] == [(a, len(v)) for a, v in told]
        sizes.add(tuple(map(len, sent)))
    assert len(sizes) == 1


def _read(packet: bytes) -> list[Any]:
    return list(OscBundle(packet)) if OscBundle.dgram_is_bundle(packet) else [OscMessage(packet)]


@pytest.fixture
def port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.mark.parametrize("bundles", [True, False])
def test_vmcp_hears_what_was_sent(port: int, bundles: bool) -> None:
    moment, count = posed(STOCK)[0], len(STOCK.skeleton.names)
    listening = subprocess.Popen([sys.executable, str(JUDGE), str(port), str(count)], stdout=subprocess.PIPE, text=True)
    assert listening.stdout is not None
    assert listening.stdout.readline() == "ready\n"
    with VmcStream(VmcSettings(port=port, bundles=bundles)) as stream:
        assert stream.show("first", STOCK, moment)
        assert not stream.show("second", STOCK, moment)  # one at a time
        stream.release("first")
    heard = json.loads(listening.communicate(timeout=60)[0])
    told = {values[0]: values[1:] for address, values in messages(Puppet.of(STOCK), moment) if "Pos" in address}
    found = {name: numbers for _, name, *numbers in [event for event in heard if len(event) > 1]}
    assert found.keys() == told.keys()
    for name, numbers in found.items():
        np.testing.assert_allclose(numbers, told[name], atol=1e-6, err_msg=name)
    assert {"StateEvent", "RelativeTimeEvent"} <= {event[0] for event in heard}


@pytest.fixture(scope="module")
def godot(tmp_path_factory: pytest.TempPathFactory) -> GodotJudge:
    return GodotJudge(tmp_path_factory.mktemp("godot"))


@pytest.mark.parametrize("bundles", [True, False])
@pytest.mark.parametrize("name", ["stock", "VRM 0.x"])
def test_godot_puts_every_joint_where_the_page_does(godot: GodotJudge, name: str, bundles: bool, port: int) -> None:
    humanoid = body(name)
    moment, joints = posed(humanoid)
    settings = VmcSettings(port=port, bundles=bundles, locomotion=Locomotion.HIPS)  # the add-on ignores the root
    with VmcStream(settings) as stream:
        places = godot.heard(port, lambda: stream.show("first", humanoid, moment))["places"]
    numbers = [i for i, bone in enumerate(humanoid.skeleton.names) if unity_name(bone) in places]
    assert len(numbers) >= 18
    found = np.array([places[unity_name(humanoid.skeleton.names[i])] for i in numbers])
    wanted = joints[numbers] * [-1.0, 1.0, -1.0]
    if name != "stock":  # the add-on loads no file: it does not know what its hips hang on
        found, wanted = found - found[0], wanted - wanted[0]
    np.testing.assert_allclose(found, wanted, atol=1e-5)


def test_nobody_there_is_no_fault(port: int) -> None:
    with VmcStream(VmcSettings(port=port)) as stream:
        assert all(stream.show(stream, STOCK, replace(posed(STOCK)[0], time=float(i))) for i in range(5))


@pytest.mark.parametrize(
    ("address", "host", "port"),
    [("39540", "127.0.0.1", 39540), ("localhost", "localhost", 39539), ("10.0.0.7:5000", "10.0.0.7", 5000)],
)
def test_addresses_are_read(address: str, host: str, port: int) -> None:
    settings = VmcSettings.parse(address)
    assert (settings.host, settings.port) == (host, port)


@pytest.mark.parametrize("address", ["host:", "host:0", "host:70000", "a:b", "0"])
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(InputError, match="is no address"):
        VmcSettings.parse(address)
    with pytest.raises(InputError, match="vmc root: 'feet'"):
        VmcSettings.parse("1", "feet")


def test_a_live_session_sends_what_it_shows(hearing: tuple[int, list[bytes]]) -> None:
    port, heard = hearing
    with (
        VmcStream(VmcSettings(port=port)) as stream,
        closing(Library.open("empty")) as library,
        running(replace(library, vmc=stream)) as url,
        client_of(url) as client,
    ):
        began = client.frame()
        client.press(forward=1.0)
        there = client.frame(lambda frame: math.hypot(frame.x - began.x, frame.z - began.z) > 0.3)
    told = [message for packet in heard for message in _read(packet)]
    sent = np.array([message.params[1:4] for message in told if message.address == "/VMC/Ext/Root/Pos"])
    for frame in (began, there):
        assert np.linalg.norm(sent - [-frame.x, frame.y, frame.z], axis=1).min() < 1e-4


@pytest.fixture
def hearing() -> Iterator[tuple[int, list[bytes]]]:
    """A port, and all that comes to it."""
    heard: list[bytes] = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as opened:
        opened.bind(("127.0.0.1", 0))

        def listen() -> None:
            while packet := opened.recv(65536):
                heard.append(packet)

        listening = threading.Thread(target=listen)
        listening.start()
        yield opened.getsockname()[1], heard
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ending:
            ending.sendto(b"", opened.getsockname())
        listening.join()
