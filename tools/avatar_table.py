"""The table of avatars in docs/avatars.md: what was found in each file, how it crosses a scene, how its feet stand.

Call: python tools/avatar_table.py FOLDER [--scene a] [--planner exact]
Prints Markdown; every file below the folder is read, and those that are humanoids walk, each with the given planner.
"""

import argparse
from collections import Counter
from pathlib import Path

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.inspection import inspect_avatar
from elbowroom.errors import InputError
from elbowroom.experiment.crossing import controller_for, run_crossing, warm_up
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.motion.report import run
from elbowroom.experiment.motion.settings import STEADY, MotionSettings
from elbowroom.planning.names import DEFAULT_PLANNER
from elbowroom.world.scene import Scene

SUFFIXES = (".vrm", ".glb", ".gltf", ".x3d", ".x3dv", ".wrl")
HEAD = "| file | bones, found by | height | stride at 1.1 m/s | capsules cover | scene {} | time | feet slide, sink |\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--scene", default="a")
    parser.add_argument("--planner", default=DEFAULT_PLANNER)
    chosen = parser.parse_args()
    scene, settings = Scene.load(chosen.scene), CrossingSettings(chosen.planner)
    print(HEAD.format(chosen.scene.upper()) + 8 * "|---" + "|")
    for path in sorted(path for path in chosen.folder.rglob("*") if path.suffix.lower() in SUFFIXES):
        print(_row(path, path.relative_to(chosen.folder), scene, settings), flush=True)


def _row(path: Path, name: Path, scene: Scene, settings: CrossingSettings) -> str:
    try:
        facts, humanoid = inspect_avatar(path)
    except InputError as error:
        return f"| `{name}` | refused: {str(error).partition(': ')[2]} | | | | | | |"
    controller = controller_for(humanoid, scene, settings)
    warm_up(controller)
    result = run_crossing(controller, settings)
    walked = ("straight" if result.straight else "passed") if result.passed else "not crossed"
    took = "" if result.passed_time_s is None else f"{result.passed_time_s:.1f} s"
    how = Counter(str(source["how"]) for source in facts.bones.values())
    found = ", ".join(f"{count} {source}" for source, count in how.most_common())
    covered = f"{facts.coverage.share:.1%}" if facts.coverage else "no mesh of a body"
    size = f"{facts.height:.2f} m | {facts.stride:.2f} m"
    return f"| `{name}` | {found} | {size} | {covered} | {walked} | {took} | {_feet(humanoid)} |"


def _feet(humanoid: Humanoid) -> str:
    """How far soles slide while they stand (99 %), and are in the ground, in an even walk, on their own surface."""
    feet = run(humanoid, MotionSettings((STEADY,), (1.1,), ())).feet[STEADY]
    return f"{feet.as_planned.p99:.1f}, {feet.in_ground:.1f} mm"


if __name__ == "__main__":
    main()
