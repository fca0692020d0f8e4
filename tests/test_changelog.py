"""The changelog keeps the form of Keep a Changelog, and its newest version is the package's."""

import re
from itertools import pairwise
from pathlib import Path

import elbowroom

CHANGELOG = (Path(__file__).parents[1] / "CHANGELOG.md").read_text("utf-8")
HEADINGS = re.findall(r"^## (.*)$", CHANGELOG, flags=re.MULTILINE)
RELEASE = re.compile(r"\[(\d+)\.(\d+)\.(\d+)\] - (\d{4}-\d\d-\d\d)")
KINDS = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]


def releases() -> list[tuple[tuple[int, ...], str]]:
    """Version and date of each release, in the file's order."""
    found = [RELEASE.fullmatch(heading) for heading in HEADINGS if heading != "[Unreleased]"]
    return [(tuple(map(int, match.groups()[:3])), match[4]) for match in found if match is not None]


def test_every_heading_is_unreleased_or_a_version_with_its_date() -> None:
    assert len(releases()) == len([heading for heading in HEADINGS if heading != "[Unreleased]"])
    assert "[Unreleased]" not in HEADINGS[1:], "what is not released stands on top"


def test_versions_and_dates_fall_from_top_to_bottom() -> None:
    for (version, date), (older, earlier) in pairwise(releases()):
        assert version > older
        assert date >= earlier


def test_the_newest_release_is_the_packages_version() -> None:
    assert ".".join(map(str, releases()[0][0])) == elbowroom.__version__


def test_changes_stand_under_the_six_kinds() -> None:
    for version in re.split(r"^## ", CHANGELOG, flags=re.MULTILINE)[1:]:
        kinds = re.findall(r"^### (.*)$", version, flags=re.MULTILINE)
        assert kinds == [kind for kind in KINDS if kind in kinds], version.splitlines()[0]
        assert "\n- " in version
        assert not re.search(r"^- ", version.split("### ")[0], flags=re.MULTILINE), "a change without its kind"


def test_no_change_is_told_twice() -> None:
    changes = re.findall(r"^- .*$", CHANGELOG, flags=re.MULTILINE)
    assert len(changes) == len(set(changes))
