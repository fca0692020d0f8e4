"""Runs in Blender's own Python (`bpy`): the world places of all bones in a file, at some frames.

Call: python blender.py FILE FPS FRAMES NAMES [PICTURE]; prints one JSON object. Axes are turned back to Y up, units to
metres where Blender's importer does not do so itself.
"""

import json
import sys
from pathlib import Path

import bpy
from mathutils import Vector


def read(path: Path, fps: float) -> int:
    """Open a file in an empty scene that plays at its rate; the scene's frame at which it begins."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = round(fps)
    if path.suffix == ".bvh":
        bpy.ops.import_anim.bvh(filepath=str(path), global_scale=0.01, axis_forward="-Z", axis_up="Y", frame_start=1)
        return 1  # the importer knows no earlier one
    if path.suffix == ".glb":
        bpy.ops.import_scene.gltf(filepath=str(path))
    elif path.suffix == ".usda":
        bpy.ops.wm.usd_import(filepath=str(path))
    return 0


def places(first: int, frames: list[int], names: list[str]) -> list[list[list[float]]]:
    """World places of the bones' joints, Y up."""
    figure = next(thing for thing in bpy.context.scene.objects if thing.type == "ARMATURE")
    bones = {bone.name.split("/")[-1]: bone for bone in figure.pose.bones}
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(first + frame)
        heads: list[Vector] = [figure.matrix_world @ bones[name].head for name in names]
        found.append([[place.x, place.z, -place.y] for place in heads])
    return found


def main() -> None:
    path, fps, frames, names = Path(sys.argv[1]), float(sys.argv[2]), json.loads(sys.argv[3]), json.loads(sys.argv[4])
    first = read(path, fps)
    print(json.dumps({"version": bpy.app.version_string, "places": places(first, frames, names)}))


main()
