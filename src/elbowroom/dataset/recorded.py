"""A walk of a dataset as a recording, to be looked at and exported."""

from pathlib import Path

from elbowroom.control.recordings.recording import Recorder
from elbowroom.dataset.company import NoRoomError
from elbowroom.dataset.draw import draw
from elbowroom.dataset.spec import DatasetSpec
from elbowroom.dataset.walk import company_on, controller_of, setting_of, steps_of
from elbowroom.errors import InputError
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.gauntlet.course import NoCourseError


def record_walk(spec: DatasetSpec, number: int, path: Path) -> None:
    """Walk it again, into a recording; raises `InputError` where the seed gives no course."""
    drawn = draw(spec, number)
    try:
        setting = setting_of(drawn)
    except NoCourseError:
        raise InputError(f"walk {number}: its seed gives no course for this body") from None
    controller = controller_of(spec, drawn, setting)
    try:
        company = company_on(drawn, setting, controller)
    except NoRoomError as error:
        raise InputError(f"walk {number}: {error}") from None
    with Recorder(path, controller) as recorder:
        for _, frame in steps_of(spec, drawn, setting, controller, company):
            recorder.append(frame, DT)
