"""The log of trials: nothing that was finished is lost, nothing foreign gets in."""

import json
from pathlib import Path

import pytest

from elbowroom.errors import InputError
from elbowroom.experiment.trial_log import TrialLog, digest

SETTINGS = {"limit": 30.0, "avatar": "stock"}


def test_what_was_appended_is_there_again(tmp_path: Path) -> None:
    with TrialLog(tmp_path / "new", SETTINGS) as log:
        log.append("one", {"passed": True, "least_clearance": float("inf")})
        log.append("two", {"passed": False})
    with TrialLog(tmp_path / "new", SETTINGS) as log:
        assert log.done == {"one": {"passed": True, "least_clearance": float("inf")}, "two": {"passed": False}}
        log.append("three", {})
    with TrialLog(tmp_path / "new", SETTINGS) as log:
        assert list(log.done) == ["one", "two", "three"]


def test_a_trial_is_on_disk_before_append_returns(tmp_path: Path) -> None:
    with TrialLog(tmp_path, SETTINGS) as log:
        log.append("one", {"passed": True})
        assert log.path.read_text().endswith('{"key":"one","record":{"passed":true}}\n')


def test_a_file_cut_off_anywhere_keeps_its_whole_lines_and_goes_on(tmp_path: Path) -> None:
    with TrialLog(tmp_path, SETTINGS) as log:
        for key in "abc":
            log.append(key, {"value": key})
        path = log.path
    whole = path.read_bytes()
    for length in range(whole.index(b"\n") + 1, len(whole)):
        path.write_bytes(whole[:length])
        lines = whole[:length].count(b"\n") - 1
        with TrialLog(tmp_path, SETTINGS) as log:
            # The last record may be whole although its line end is missing.
            assert len(log.done) in (lines, lines + 1)
            log.append("z", {"value": "z"})
        with TrialLog(tmp_path, SETTINGS) as log:
            assert log.done["z"] == {"value": "z"}
            assert len(log.done) >= lines + 1


def test_other_settings_are_kept_apart(tmp_path: Path) -> None:
    with TrialLog(tmp_path, SETTINGS) as log:
        log.append("one", {"passed": True})
    with TrialLog(tmp_path, SETTINGS | {"limit": 10.0}) as other:
        assert other.done == {}
        assert other.others == 1
        assert other.path != log.path
    with TrialLog(tmp_path, SETTINGS) as log:
        assert list(log.done) == ["one"]


def test_a_foreign_file_of_that_name_is_refused_and_left_alone(tmp_path: Path) -> None:
    path = tmp_path / f"trials-{digest(SETTINGS)[:12]}.jsonl"
    path.write_text('{"something": "else"}\n')
    with pytest.raises(InputError, match="no log of trials"):
        TrialLog(tmp_path, SETTINGS)
    assert path.read_text() == '{"something": "else"}\n'


def test_a_folder_that_cannot_be_made_is_a_plain_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        TrialLog(tmp_path / "file" / "folder", SETTINGS)


def test_a_digest_is_of_the_content() -> None:
    assert digest({"a": 1, "b": [2.0]}) == digest(json.loads('{"b": [2.0], "a": 1}'))
    assert digest({"a": 1}) != digest({"a": 2})
