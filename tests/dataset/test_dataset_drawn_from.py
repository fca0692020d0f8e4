"""What a dataset's spec names and is not there is told before anything is walked, in one line, with the mend."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from elbowroom.cli.main import app

WRONG = {
    "swings": ("gone.bvh", "gone.bvh: cannot be read"),
    "avatars": ("gone.vrm", "gone.vrm"),
    "places": ("gone.json", "gone.json"),
    "a place by name": ("nowhere", "'nowhere' is neither a stock scene"),
    "a model": ("gone.glb", "gone.glb"),
    "a damaged clip": ("damaged.bvh", "damaged.bvh: line 2"),
}
LISTS = {"a place by name": "places", "a model": "places", "a damaged clip": "swings"}


@pytest.mark.parametrize("what", WRONG)
def test_it_is_told_before_the_first_walk(what: str, tmp_path: Path) -> None:
    (tmp_path / "damaged.bvh").write_text("HIERARCHY\nROOT\n")
    entry, said = WRONG[what]
    listed = LISTS.get(what, what)
    spec = tmp_path / "spec.json"
    good = "b" if listed == "places" else "stock"
    spec.write_text(json.dumps({"walks": 2, "places": ["a"], listed: [good, entry]}))
    result = CliRunner().invoke(app, ["dataset", str(spec), "-o", str(tmp_path / "out")])
    assert result.exit_code == 2
    (told,) = result.output.splitlines()
    assert str(spec) in told
    assert said in told
    assert f"mend it in '{listed}', or take it out" in told
    assert not (tmp_path / "out").exists()
