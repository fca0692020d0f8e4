"""Walks among things that move and stop for nobody: who can get out of their way is not run over."""

from dataclasses import replace
from pathlib import Path

import pytest

from elbowroom.dataset.draw import draw
from elbowroom.dataset.spec import DatasetSpec
from elbowroom.dataset.walk import company_on, controller_of, setting_of, steps_of

STOCK = DatasetSpec.load(Path(__file__).parents[2] / "examples" / "dataset.json")
MOVING = ("traffic", "shapes")


def touching(spec: DatasetSpec, number: int) -> list[float]:
    """When the avatar of a walk touches anything, seconds."""
    drawn = draw(spec, number)
    setting = setting_of(drawn)
    controller = controller_of(spec, drawn, setting)
    steps = steps_of(spec, drawn, setting, controller, company_on(drawn, setting, controller))
    return [frame.time for _, frame in steps if frame.touching]


@pytest.mark.parametrize(
    ("number", "seconds", "what"),
    [
        (1400, 9.0, "who is kept from walking on by a hair stops in the way of a barrel"),
        (237, 5.6, "who begins to strafe stops in the way of a trolley"),
        (748, 5.6, "who turns round stops in the way of a trolley"),
    ],
)
def test_who_was_run_over_once_is_not_again(number: int, seconds: float, what: str) -> None:
    assert draw(STOCK, number).place in MOVING, what
    assert touching(replace(STOCK, seconds=seconds), number) == [], what


@pytest.mark.long
def test_nearly_nobody_is_run_over_however_he_steers() -> None:
    """Of 160 walks one is: its shown feet stand a little behind those that were planned."""
    spec = replace(STOCK, places=MOVING, seed=7, walks=160)
    assert {draw(spec, number).steering for number in range(160)} == set(spec.steering)
    assert sum(bool(touching(spec, number)) for number in range(160)) <= 1
