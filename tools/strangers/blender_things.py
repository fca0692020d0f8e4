"""Runs in Blender's own Python (`bpy`): the boxes round all objects of a GLB, and the places of bones, at some frames.

Call: python blender_things.py FILE FPS FRAMES BONES; prints one JSON object. Axes are turned back to Y up.
"""

import json
import sys
from pathlib import Path

import bpy
from mathutils import Vector


def back(place: Vector) -> list[float]:
    return [place.x, place.z, -place.y]


def things() -> dict[str, list[list[float]]]:
    """The corners of the boxes, by the objects' names."""
    meshes = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
    return {thing.name: [back(thing.matrix_world @ Vector(at)) for at in thing.bound_box] for thing in meshes}


def bones(names: list[str]) -> list[list[float]]:
    """World places of bones."""
    if not names:
        return []
    figure = next(thing for thing in bpy.context.scene.objects if thing.type == "ARMATURE")
    return [back(figure.matrix_world @ figure.pose.bones[name].head) for name in names]


def main() -> None:
    path, fps, frames, names = Path(sys.argv[1]), float(sys.argv[2]), json.loads(sys.argv[3]), json.loads(sys.argv[4])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = round(fps)
    bpy.ops.import_scene.gltf(filepath=str(path))
    told = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        told.append((things(), bones(names)))
    shown, places = zip(*told, strict=True)
    print(json.dumps({"version": bpy.app.version_string, "things": shown, "places": places}))


main()
