"""How far the things of an exported scene, and of a whole run, are from ours in the programs of others."""

import json
import subprocess
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from avatar_builder import json_of
from gltf_judge import validated
from strangers.place import GLB, RUN, X3D, Place
from strangers.programs import HERE, Finding
from three_judge import ThreeJudge
from x_ite import XIte


def validator(place: Place) -> Iterator[Finding]:
    """Khronos' validator."""
    for ending in (GLB, RUN):
        report = validated(place.files[ending].read_bytes())
        yield Finding("glTF validator", report["validatorVersion"], ending, None, report["issues"]["numErrors"])


def trimesh_(place: Place) -> Iterator[Finding]:
    """trimesh, as things stand at the beginning; of a run it shows no motion."""
    for ending in (GLB, RUN):
        read = trimesh.load_scene(place.files[ending])
        found = {}
        for node in read.graph.nodes_geometry:
            matrix, geometry = read.graph[node]
            box: Any = trimesh.bounds
            found[node] = trimesh.transform_points(box.corners(read.geometry[geometry].bounds), matrix)
        yield Finding("trimesh", version("trimesh"), ending, place.away(0.0, found))


def three(chromium: Any, place: Place) -> Iterator[Finding]:
    """three.js."""
    judge = ThreeJudge(chromium)
    release, walk = f"0.{judge.release()}", place.walk
    (found,) = judge.things(place.files[GLB].read_bytes(), [0.0])
    yield Finding("three.js", release, GLB, place.away(0.0, found))
    glb = place.files[RUN].read_bytes()
    worst = max(map(place.away, place.run_times, judge.things(glb, walk.times)))
    names = [node.get("name") for node in json_of(glb)["nodes"]]
    joints = np.array(judge.nodes(glb, 0, walk.times))[:, [names.index(name) for name in walk.names], :3]
    yield Finding("three.js", release, RUN, max(worst, walk.away(joints)))
    judge.close()


def x_ite(chromium: Any, place: Place) -> Iterator[Finding]:
    """X_ITE."""
    judge = XIte(chromium)
    told = judge.things(place.files[X3D].read_text("utf-8"), [place.fractions(time) for time in place.times])
    names = ("ground", "finish", *place.corners(0.0))  # in the order of the file
    shown = [dict(zip(names, corners, strict=True)) for corners in told["shown"]]
    yield Finding("X_ITE", told["version"], X3D, max(map(place.away, place.times, shown)))
    judge.close()


def blender(python: Path, place: Place) -> Iterator[Finding]:
    """Blender's importer of glTF."""
    walk = place.walk
    for ending, frames, times in ((GLB, [0], [0.0]), (RUN, walk.frames, place.run_times)):
        bones = json.dumps(walk.names if ending == RUN else [])
        script, file = HERE / "blender_things.py", place.files[ending]
        call = [str(python), str(script), str(file), str(walk.animation.fps), json.dumps(frames), bones]
        done = subprocess.run(call, capture_output=True, text=True, check=True, timeout=300)
        told = json.loads(done.stdout.strip().splitlines()[-1])
        worst = max(map(place.away, times, told["things"]))
        yield Finding(
            "Blender", told["version"], ending, max(worst, walk.away(told["places"]) if ending == RUN else 0.0)
        )
