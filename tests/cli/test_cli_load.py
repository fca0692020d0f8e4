"""`elbowroom doctor --load`: users who steer a server, and what is made of it."""

from contextlib import closing
from dataclasses import replace

import pytest

from elbowroom.cli.doctor import doctor, load
from elbowroom.cli.doctor.load import Load, load_faults, measure_load
from elbowroom.errors import InputError
from elbowroom.server.entrance import admission
from elbowroom.server.stores.library import Library
from live_session import running

GOOD = Load(16, 16, 10.0, 58.0, 99.5, 99.0, 25.0, 12.0, 60.0, 130.0, 99.2, 150.0, 9.0, 7.0, 20.0)


def test_a_broken_promise_is_a_fault() -> None:
    assert load_faults(GOOD) == []
    assert load_faults(replace(GOOD, served=15)) == ["only 15 of 16 users were served"]
    assert "25 ms late" in load_faults(replace(GOOD, on_time_percent=98.9))[0]
    assert "150 ms" in load_faults(replace(GOOD, answered_in_time_percent=98.9))[0]
    assert doctor._load_faults(None) == []
    assert doctor._load_faults(vars(replace(GOOD, served=15)))


def test_it_is_told_in_two_lines() -> None:
    text = "\n".join(line for _, line in doctor._load_rows(vars(GOOD)))
    assert "16 of 16 users served for 10 s: 58.0 frames/s each, 99.50 % of them in time" in text
    assert "9.0 % of one core and 7.0 MB each" in text


@pytest.mark.long
def test_users_come_steer_and_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(load, "_SETTLE", 0.5)
    monkeypatch.setattr(load, "_AGAIN", 0.1)
    monkeypatch.setattr(admission, "MOST", 1)  # the second one is refused again and again
    with closing(Library.open("d")) as library, running(library) as url:
        library.warm.set()
        found = measure_load(2, 5.0, url)
    assert (found.sessions, found.served) == (2, 1)
    assert found.frames_per_second > 0.0
    assert found.cpu_percent > 0.0
    assert 0.0 <= found.on_time_percent <= 100.0


def test_where_no_server_is_it_is_said_so() -> None:
    with pytest.raises(InputError, match="no server of elbowroom answers there"):
        measure_load(1, 1.0, "http://127.0.0.1:1")
