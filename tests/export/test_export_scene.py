"""A scene alone as GLB and X3D, read again by the readers of places."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.cli.main import app
from elbowroom.export.place import place_glb
from elbowroom.export.place_x3d import place_x3d
from elbowroom.formats.gltf import parse_gltf
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import Scene

RUNNER = CliRunner()


@pytest.mark.parametrize(("ending", "write"), [("glb", place_glb), ("x3d", place_x3d)])
@pytest.mark.parametrize("name", ["d", "shapes"])
def test_what_is_written_is_read_again_as_the_same_place(tmp_path: Path, name: str, ending: str, write) -> None:  # type: ignore[no-untyped-def]
    scene = Scene.load(name)
    file = tmp_path / f"{name}.{ending}"
    file.write_bytes(write(scene))
    again = Scene.load(file, PlaceOptions(scale=1.0, up="y"))
    standing = _extent(*scene.obstacles.first_bounds())
    read = _extent(*again.obstacles.first_bounds())
    np.testing.assert_allclose(read, standing, atol=0.02)


def _extent(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Without what is flat on the ground: the middle heights and the widths of all together."""
    tall = high[:, 1] > 0.05
    return np.concatenate([low[tall].min(axis=0), high[tall].max(axis=0)])


def test_names_and_colours_are_kept(tmp_path: Path) -> None:
    box = {"type": "box", "name": 'a "crate" & more', "center": [0, 0.5, 2], "size": [1, 1, 1], "color": "#ff0000"}
    scene = Scene.of("attic", [box], finish=(0.0, 4.0))
    nodes = parse_gltf(place_glb(scene), "attic.glb").root.at("nodes").items()
    assert 'a "crate" & more' in {node.at("name").text() for node in nodes}
    text = place_x3d(scene).decode()
    assert 'diffuseColor="1 0 0"' in text
    assert "crate" in text


def test_a_scene_is_exported_from_the_command_line(tmp_path: Path) -> None:
    out = tmp_path / "traffic.x3d"
    result = RUNNER.invoke(app, ["export", "--scene", "traffic", "-o", str(out)])
    assert result.exit_code == 0, result.output
    moving: Moving = Scene.load("traffic").obstacles.moving
    assert out.read_text("utf-8").count("<PositionInterpolator") == len(moving)
    for wrong in (["export", "-o", str(tmp_path / "a.glb")], ["export", "--scene", "d", "-o", str(tmp_path / "a.bvh")]):
        refused = RUNNER.invoke(app, wrong)
        assert refused.exit_code != 0
    assert RUNNER.invoke(app, ["export", "--scene", "d", "-o", str(out)]).exit_code != 0
