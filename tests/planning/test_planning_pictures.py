"""The pictures of docs/planner.md are drawn by the planner as it is."""

import subprocess
import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[2]
PICTURES = ("slice-table.svg", "joint-step.svg")


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pictures")
    subprocess.run([sys.executable, ROOT / "tools/make_planner_pictures.py", folder], check=True)
    return folder


def parts(picture: Path) -> Counter[str]:
    """How often each kind of element is in a picture."""
    return Counter(element.tag for element in ElementTree.parse(picture).iter())


@pytest.mark.long
@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_has_what_the_kept_one_has(drawn: Path, name: str) -> None:
    now, previous = parts(drawn / name), parts(ROOT / "docs/images" / name)
    assert set(now) == set(previous)
    assert sum(now.values()) == pytest.approx(sum(previous.values()), rel=0.05)
