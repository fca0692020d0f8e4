"""What a crowd costs is counted for each of its members."""

import pytest

from elbowroom.errors import InputError
from elbowroom.experiment.bench.crowd import amount, run
from elbowroom.experiment.bench.settings import CrowdSettings


@pytest.mark.long
def test_each_crowd_walks_and_stands_and_is_counted() -> None:
    settings, done = CrowdSettings((1, 2), seconds=0.5, settle=0.1), list[int]()
    report = run(settings, done.append)
    assert done == list(range(1, amount(settings) + 1))
    assert {cost.what for cost in report.costs} == {"walking in the open", "walking scene D", "standing"}
    for cost in report.costs:
        assert 0.0 < cost.own_mb < 5.0
        assert 0.0 < cost.frame_ms <= cost.frame_worst_ms
        assert cost.made_ms > 0.0
        assert cost.at_60_hz > 0
    assert report.as_dict()["settings"]["avatars"] == (1, 2)


@pytest.mark.parametrize("avatars", [(), (0,), (5000,)])
def test_a_crowd_of_no_size_is_refused(avatars: tuple[int, ...]) -> None:
    with pytest.raises(InputError):
        CrowdSettings(avatars)
