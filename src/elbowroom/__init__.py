"""You steer; your avatar finds the elbow room.

>>> import elbowroom as er
>>> controller = er.Controller(er.Humanoid.default(), er.Scene.load("a"), seed=0)
>>> frame = controller.step(er.Command(forward=1.0), dt=1 / 60)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from elbowroom.body.humanoid import Humanoid as Humanoid
    from elbowroom.body.loading.settings import LoadSettings as LoadSettings
    from elbowroom.body.root import RootState as RootState
    from elbowroom.clips.clip import Clip as Clip
    from elbowroom.clips.clip import motions_of as motions_of
    from elbowroom.control.controller import Controller as Controller
    from elbowroom.control.frame import Frame as Frame
    from elbowroom.control.frame import Phase as Phase
    from elbowroom.control.plans.lookahead import Lookahead as Lookahead
    from elbowroom.control.recordings.recording import Recorder as Recorder
    from elbowroom.control.recordings.recording import Recording as Recording
    from elbowroom.control.shown.body_check import BodyCheck as BodyCheck
    from elbowroom.errors import InputError as InputError
    from elbowroom.planning.command import Command as Command
    from elbowroom.planning.goal import natural_walk as natural_walk
    from elbowroom.planning.navigation.way import NoWayError as NoWayError
    from elbowroom.planning.planner import Planner as Planner
    from elbowroom.planning.planner import register_planner as register_planner
    from elbowroom.planning.result import LocalPlan as LocalPlan
    from elbowroom.planning.result import PlanStatus as PlanStatus
    from elbowroom.planning.root.path import RootPath as RootPath
    from elbowroom.server.standalone.notebook import show as show
    from elbowroom.world.places.options import PlaceOptions as PlaceOptions
    from elbowroom.world.scene import Gate as Gate
    from elbowroom.world.scene import Scene as Scene

__version__ = "0.1.0"

# Where each public name lives; it is imported when it is first asked for, so that `import elbowroom` costs nothing.
_HOMES = {
    "BodyCheck": "control.shown.body_check",
    "Clip": "clips.clip",
    "Command": "planning.command",
    "Controller": "control.controller",
    "Frame": "control.frame",
    "Gate": "world.scene",
    "Humanoid": "body.humanoid",
    "InputError": "errors",
    "LoadSettings": "body.loading.settings",
    "LocalPlan": "planning.result",
    "Lookahead": "control.plans.lookahead",
    "NoWayError": "planning.navigation.way",
    "Phase": "control.frame",
    "PlaceOptions": "world.places.options",
    "PlanStatus": "planning.result",
    "Planner": "planning.planner",
    "Recorder": "control.recordings.recording",
    "Recording": "control.recordings.recording",
    "RootPath": "planning.root.path",
    "RootState": "body.root",
    "Scene": "world.scene",
    "motions_of": "clips.clip",
    "natural_walk": "planning.goal",
    "register_planner": "planning.planner",
    "show": "server.standalone.notebook",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'elbowroom' has no attribute {name!r}")
    value = getattr(import_module(f"elbowroom.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})


def public_names() -> tuple[str, ...]:
    """The names that programs may rely on; `docs/reference.md` shows each of them."""
    return tuple(_HOMES)
