"""The table of avatars in docs/avatars.md: what was found in each file, and how it crosses a scene.

Call: python tools/avatar_table.py FOLDER [--scene a] [--planner exact]
Prints Markdown; every file below the folder is read, and those that are humanoids walk, each with the given planner.
"""

import argparse
from collections import Counter
from pathlib import Path

from elbowroom.body.loading.inspection import inspect_avatar
from elbowroom.errors import InputError
from elbowroom.experiment.crossing import controller_for, run_crossing, warm_up
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.planning.names import DEFAULT_PLANNER
from elbowroom.world.scene import Scene

SUFFIXES = (".vrm", ".glb", ".gltf", ".x3d", ".x3dv", ".wrl")
HEAD = "| file | bones, found by | height | stride at 1.1 m/s | capsules cover | scene {} | time |\n" + 7 * "|---" + "|"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--scene", default="a")
    parser.add_argument("--planner", default=DEFAULT_PLANNER)
    chosen = parser.parse_args()
    scene, settings = Scene.load(chosen.scene), CrossingSettings(chosen.planner)
    print(HEAD.format(chosen.scene.upper()))
    for path in sorted(path for path in chosen.folder.rglob("*") if path.suffix.lower() in SUFFIXES):
        print(_row(path, path.relative_to(chosen.folder), scene, settings), flush=True)


def _row(path: Path, name: Path, scene: Scene, settings: CrossingSettings) -> str:
    try:
        facts, humanoid = inspect_avatar(path)
    except InputError as error:
        return f"| `{name}` | refused: {str(error).partition(': ')[2]} | | | | | |"
    controller = controller_for(humanoid, scene, settings)
    warm_up(controller)
    result = run_crossing(controller, settings)
    walked = ("straight" if result.straight else "passed") if result.passed else "not crossed"
    took = "" if result.passed_time_s is None else f"{result.passed_time_s:.1f} s"
    how = Counter(str(source["how"]) for source in facts.bones.values())
    found = ", ".join(f"{count} {source}" for source, count in how.most_common())
    covered = f"{facts.coverage.share:.1%}" if facts.coverage else "no mesh of a body"
    return f"| `{name}` | {found} | {facts.height:.2f} m | {facts.stride:.2f} m | {covered} | {walked} | {took} |"


if __name__ == "__main__":
    main()
