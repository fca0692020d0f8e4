"""The documentation builds without a warning, is whole, and needs no network."""

import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

import griffe
import pytest

import elbowroom
from field_comments import FieldComments

ROOT = Path(__file__).parents[1]
PUBLIC = sorted(elbowroom.public_names())
SHOWN = re.findall(r"^::: (\S+)$", (ROOT / "docs" / "reference.md").read_text("utf-8"), flags=re.MULTILINE)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    built = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert built.returncode == 0, built.stderr
    return folder


@pytest.fixture(scope="module")
def package() -> griffe.Object:
    return griffe.load("elbowroom", search_paths=[ROOT / "src"], extensions=griffe.load_extensions(FieldComments))  # type: ignore[return-value]


def test_every_page_of_the_docs_is_in_the_site(site: Path) -> None:
    for page in (ROOT / "docs").glob("*.md"):
        assert (site / page.with_suffix(".html").name).is_file()
        assert page.name in (ROOT / "mkdocs.yml").read_text("utf-8"), f"{page.name} is not in the navigation"


def test_the_site_loads_nothing_from_the_network(site: Path) -> None:
    for page in site.rglob("*.html"):
        loaded = re.findall(r'<(?:script|img|iframe)[^>]*\ssrc="([^"]*)"', page.read_text("utf-8"))
        loaded += re.findall(r'<link[^>]*\shref="([^"]*)"', page.read_text("utf-8"))
        assert loaded
        assert not [address for address in loaded if "//" in address], page.name


@pytest.mark.parametrize("name", PUBLIC)
def test_the_reference_shows_every_public_name_with_its_methods(name: str, site: Path) -> None:
    assert f"elbowroom.{name}" in SHOWN
    page = (site / "reference.html").read_text("utf-8")
    thing = getattr(elbowroom, name)
    assert f'id="elbowroom.{name}"' in page
    methods = [member for member in vars(thing) if not member.startswith("_")] if inspect.isclass(thing) else []
    for member in methods:
        assert f'id="elbowroom.{name}.{member}"' in page, f"{name}.{member} is not shown"


@pytest.mark.parametrize("path", SHOWN)
def test_the_reference_has_a_sentence_for_everything_that_it_shows(path: str, package: griffe.Object) -> None:
    module, name = path.rsplit(".", 1)
    home = getattr(importlib.import_module(module), name).__module__ if module == "elbowroom" else module
    thing = package[f"{home}.{name}".removeprefix("elbowroom.")]
    assert thing.docstring, path
    for member in thing.members.values():
        if not member.name.startswith("_") and not (member.is_alias or member.inherited):
            assert member.docstring, f"{path}.{member.name} says nothing: a comment behind the field, or a docstring"
