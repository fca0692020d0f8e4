"""Export one walk, let every program that can be had read it, and print who is how far away.

Call: python tools/strangers [--docs]. Blender and OpenUSD get an environment of their own in build/strangers, of 1 GB;
a program that is not there is named and left out. Exit code 1: somebody is 1 mm away, or a validator found an error.
"""

import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tools")]

import pytest  # noqa: E402

from elbowroom.errors import InputError  # noqa: E402
from elbowroom.film.page import browser_path  # noqa: E402
from make_pictures import FLAGS  # noqa: E402
from strangers import place_programs, programs  # noqa: E402
from strangers.place import Place, exported_place  # noqa: E402
from strangers.programs import Finding, Program  # noqa: E402
from strangers.walk import SCENE, Walk, exported_walk  # noqa: E402

FOLDER = ROOT / "build" / "strangers"
PAGE = ROOT / "docs" / "export.md"
BEGIN, END = "<!-- make strangers -->", "<!-- end -->"
HEAVY = ("bpy==5.0.1", "usd-core==26.11")
LIMIT = 1.0  # millimetres


def main() -> None:
    print("a walk ...", file=sys.stderr)
    walk = exported_walk(FOLDER)
    place = exported_place(walk)
    findings = [*_local(walk, place), *_in_browser(walk, place), *_heavy(walk, place)]
    table = _table(findings)
    print(
        f"Scene {SCENE}, {len(walk.animation)} frames, {len(walk.names)} joints, {len(walk.frames)} frames compared\n"
    )
    print(table)
    if "--docs" in sys.argv:
        before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
        PAGE.write_text(f"{before}{BEGIN}\n{table}\n{END}{rest.partition(END)[2]}", "utf-8")
    bad = [one for one in findings if (one.away or 0.0) >= LIMIT or one.errors]
    sys.exit(1 if bad else 0)


def _told(program: Program, name: str) -> list[Finding]:
    """What a program finds; one that is not there says so."""
    print(f"{name} ...", file=sys.stderr)
    try:
        return list(program())
    except (pytest.skip.Exception, OSError, subprocess.SubprocessError) as error:
        print(f"{name}: left out: {error}", file=sys.stderr)
        return []


def _local(walk: Walk, place: Place) -> Iterator[Finding]:
    yield from _told(partial(programs.bvhio_, walk), "bvhio")
    for program in (partial(programs.validator, walk), partial(place_programs.validator, place)):
        yield from _told(program, "glTF validator")
    yield from _told(partial(place_programs.trimesh_, place), "trimesh")


def _in_browser(walk: Walk, place: Place) -> Iterator[Finding]:
    try:
        path = browser_path()
    except InputError as error:
        print(f"three.js, three-vrm, X_ITE: left out: {error}", file=sys.stderr)
        return
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser: Any = playwright.chromium.launch(executable_path=path, args=FLAGS)
        for program in (partial(programs.three, browser, walk), partial(place_programs.three, browser, place)):
            yield from _told(program, "three.js")
        for program in (partial(programs.x_ite, browser, walk), partial(place_programs.x_ite, browser, place)):
            yield from _told(program, "X_ITE")
        browser.close()


def _heavy(walk: Walk, place: Place) -> Iterator[Finding]:
    python = _environment()
    if python is not None:
        for program in (partial(programs.blender, python, walk), partial(place_programs.blender, python, place)):
            yield from _told(program, "Blender")
        yield from _told(partial(programs.usd, python, walk), "OpenUSD")


def _environment() -> Path | None:
    """The Python of an environment with Blender and OpenUSD in it, made when it is first needed."""
    home = FOLDER / "env"
    python, done = home / "bin" / "python", home / "done"
    if not done.exists():
        try:
            subprocess.run([sys.executable, "-m", "venv", str(home)], check=True)
            subprocess.run([str(python), "-m", "pip", "install", "--quiet", *HEAVY], check=True)
        except subprocess.CalledProcessError as error:
            print(f"Blender, OpenUSD: left out: {error}", file=sys.stderr)
            return None
        done.touch()
    return python


def _table(findings: list[Finding]) -> str:
    """Programs by formats, as Markdown."""
    formats = sorted({one.format for one in findings}, key=lambda ending: (" " in ending, ending))
    rows = dict.fromkeys((one.program, one.version) for one in findings)
    lines = ["| | " + " | ".join(map(_heading, formats)) + " |", "|---|" + "---|" * len(formats)]
    for program, release in rows:
        cells = []
        for ending in formats:
            found = [one for one in findings if (one.program, one.format) == (program, ending)]
            cells.append(", ".join(_cell(one) for one in found))
        lines.append(f"| {program} {release} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _heading(ending: str) -> str:
    what, dot, name = ending.rpartition(".")
    return f"{what}`.{name}`" if dot else f"`.{ending}`"


def _cell(found: Finding) -> str:
    words = [] if found.away is None else [f"{found.away:.4f} mm"]
    return ", ".join(words if found.errors is None else [*words, f"{found.errors} errors"])


main()
