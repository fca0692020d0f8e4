"""The report: one file, whole, and true to the table."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest

from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.report.chart import Axis
from elbowroom.experiment.report.crossings import DrawnCrossing, DrawTask
from elbowroom.experiment.report.page import report_html
from elbowroom.experiment.report.scene_picture import draw_scenes
from elbowroom.experiment.table1.settings import Table1Settings
from elbowroom.world.scene import Scene
from table1_records import ABOUT, SHORT_SCENE, made_up_table

VOID = {"meta", "br"}


class Checker(HTMLParser):
    """Counts elements, and insists that each is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.count: dict[str, int] = {}
        self.attributes: list[tuple[str, str | None]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.count[tag] = self.count.get(tag, 0) + 1
        self.attributes += attrs
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.count[tag] = self.count.get(tag, 0) + 1
        self.attributes += attrs

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def crossing() -> DrawnCrossing:
    return DrawTask("a", None, CrossingSettings(queue_size=5, seed=1, limit=2.0)).run()


@pytest.fixture(scope="module")
def report(crossing: DrawnCrossing) -> str:
    return report_html(made_up_table(), ABOUT, {"a": crossing})


def parsed(page: str) -> Checker:
    checker = Checker()
    checker.feed(page)
    checker.close()
    assert checker.open == []
    return checker


def test_the_page_is_well_formed_and_whole(report: str) -> None:
    checker = parsed(report)
    plots, pictures = 5 * 4, 2 * 4
    assert checker.count["svg"] == plots + pictures
    assert checker.count["table"] == 3
    assert checker.count["h1"] == 1
    for word in ("prefers-color-scheme: dark", "Wilson", ABOUT["machine"], ABOUT["date"], "Hsu &amp; Li"):
        assert word in report
    assert "nan" not in re.sub(r"<style>.*</style>", "", report, flags=re.DOTALL).lower().replace("planner", "")


def test_the_page_refers_to_nothing_outside_itself(report: str) -> None:
    names = {name for name, _ in parsed(report).attributes}
    assert not names & {"src", "href", "xlink:href", "srcset", "style"}
    assert not re.search(r"https?:|//\w|url\(|@import|<script|<link", report)


def test_what_comes_from_outside_is_escaped(report: str) -> None:
    assert "&lt;Stock&gt; &amp; co" in report
    assert "<Stock>" not in report


def test_every_plot_tells_what_it_is(report: str) -> None:
    for svg in re.findall(r"<svg.*?</svg>", report, flags=re.DOTALL):
        assert re.match(r"<svg[^>]*><title>[^<]+</title>", svg)


def test_a_table_of_two_planners_shows_both(crossing: DrawnCrossing) -> None:
    table = made_up_table(Table1Settings(planners=("figure6", "other"), scenes=("a", "b"), queues=(3, 4), seeds=2))
    page = report_html(table, ABOUT, {"a": crossing})
    assert parsed(page).count["svg"] == 5 * 2 + 2 * 2
    assert "series planner0" in page
    assert "series planner1" in page


def test_a_picture_shows_every_obstacle_and_every_capsule(crossing: DrawnCrossing) -> None:
    short = Scene.from_dict(SHORT_SCENE)
    ((above, beside),) = draw_scenes([short], {"short": crossing})
    for svg in (above, beside):
        assert svg.count('class="obstacle"') == 2
        assert "post &lt;thin&gt;" in svg
        for group in ("root", "waist", "head", "leftArm", "rightArm"):
            assert f'class="{group}"' in svg
        capsules = sum(svg.count(f'class="{group}"') for group in ("root", "waist", "head", "leftArm", "rightArm"))
        assert capsules == crossing.postures.shape[0] * crossing.postures.shape[1]


def test_the_pictured_crossing_is_the_trial(crossing: DrawnCrossing) -> None:
    again = DrawTask("a", None, CrossingSettings(queue_size=5, seed=1, limit=2.0)).run()
    assert np.array_equal(crossing.roots, again.roots)
    assert np.array_equal(crossing.postures, again.postures)
    assert crossing.postures.shape[1:] == (len(crossing.radii), 6)


def test_axes_place_their_ends() -> None:
    line, log = Axis(0.0, 10.0), Axis(1.0, 1000.0, log=True)
    assert line.place(5.0) == pytest.approx(0.5 * (line.place(0.0) + line.place(10.0)))
    assert log.place(10.0) - log.place(100.0) == pytest.approx(log.place(1.0) - log.place(10.0))
    assert log.place(0.001) == log.place(1.0)
    assert line.place(10.0) < line.place(0.0)
