"""The report as one page: everything is inside it, and it opens without a network."""

from collections.abc import Mapping
from html import escape
from importlib.resources import files
from typing import Any

from elbowroom.experiment.paper_table import TRIALS
from elbowroom.experiment.report.crossings import DrawnCrossing
from elbowroom.experiment.report.plots import PlotRow, figures
from elbowroom.experiment.report.scene_picture import draw_scenes
from elbowroom.experiment.report.svg import tag
from elbowroom.experiment.report.tables import canned_table, comparison_table, everything_table
from elbowroom.experiment.table1.table import Table1
from elbowroom.experiment.table1.tasks import open_scene

PAPER = "Hsu & Li, Intelligent control of third-person avatars in virtual environments (2006), Table 1"


def report_html(table: Table1, about: Mapping[str, Any], crossings: Mapping[str, DrawnCrossing]) -> str:
    """The whole page; `about` as in `table_document`, `crossings` by the scene's name."""
    body = (
        _head(table, about),
        _legend(table),
        *(_figure(figure) for figure in figures(table)),
        _pictures(table, crossings),
        _section("The table", _table_words(table), comparison_table(table)),
        _section("Without planning", _canned_words(table), canned_table(table)),
        _section("Over all trials, with 95 % intervals", _everything_words(table), everything_table(table)),
        _made(about),
    )
    style = (files("elbowroom.experiment.report") / "report.css").read_text("utf-8")
    head = (
        '<meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        '<meta name="color-scheme" content="light dark">'
        "<title>Elbowroom: the paper's Table 1</title>"
        f"<style>{style}</style>"
    )
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head>\n<body><main>\n'
        + "\n".join(body)
        + "\n</main></body></html>\n"
    )


def _head(table: Table1, about: Mapping[str, Any]) -> str:
    trials, seeds = len(table.trials), table.settings.seeds
    touching = sum(trial["least_clearance"] < 0.0 for trial in table.trials)
    shown = "No shown pose touched an obstacle" if not touching else f"{touching} trials showed a pose that touches"
    frames = sum(cell.frame_ms.count for cell in table.cells)
    words = (
        f"{_many(trials)} crossing trials, {seeds} for each cell; a scripted user walks forward, and when stuck backs "
        f"up and tries again, for at most {table.settings.limit:g} seconds. {shown}, in {_many(frames)} frames."
    )
    facts = f"{about['date']} · {about['machine']} · {about['settings']['jobs']} trials at once"
    return tag(
        "header",
        tag("h1", "Table 1, measured again"),
        tag("p", escape(words), class_="lead"),
        tag("p", escape(facts), class_="facts"),
    )


def _legend(table: Table1) -> str:
    items = [
        tag("span", tag("i", " ", class_=f"key planner{number}"), escape(name), class_="item")
        for number, name in enumerate(table.settings.planners)
    ]
    paper = tag("span", tag("i", " ", class_="key paper"), f"the paper, {TRIALS} trials a cell", class_="item")
    return tag(
        "p", *items, paper, tag("span", "Across: size of the key-frame queue, |Q|", class_="item"), class_="legend"
    )


def _figure(figure: PlotRow) -> str:
    panels = tag("div", *figure.panels, class_="panels")
    return _section(figure.heading, figure.caption, panels)


def _pictures(table: Table1, crossings: Mapping[str, DrawnCrossing]) -> str:
    scenes = [open_scene(scene) for scene in table.settings.scenes]
    pictures = []
    for scene, (above, beside) in zip(scenes, draw_scenes(scenes, crossings), strict=True):
        chosen = tag("small", escape(_crossing_words(crossings.get(scene.name))))
        caption = tag("figcaption", tag("strong", escape(scene.title)), " ", escape(scene.description), chosen)
        pictures.append(tag("figure", above, beside, caption, class_="crossing"))
    words = (
        "The collision body every half metre or so, from above and from its right side. Green its left arm, purple its "
        "right; dotted the way of the root; rings where it got stuck; the dashed line is the finish."
    )
    return _section("The scenes, each with its best crossing", words, tag("div", *pictures, class_="crossings"))


def _crossing_words(crossing: DrawnCrossing | None) -> str:
    if crossing is None:
        return "No trial got through."
    chosen = crossing.settings
    manner = "straight" if crossing.straight else f"stuck {len(crossing.stuck_at)} times on the way"
    return f"{chosen.planner}, |Q| {chosen.queue_size}, seed {chosen.seed}: {crossing.seconds:.1f} s, {manner}."


def _table_words(table: Table1) -> str:
    del table
    return (
        f"Averages over the crossings that succeeded, the paper's figure in grey beside ours. The paper's is {PAPER}. "
        "Real time: no second of any trial showed only one frame (the paper's criterion). Late: frames of all trials "
        "shown later than 1/60 s after they were due (ours)."
    )


def _canned_words(table: Table1) -> str:
    del table
    return (
        "The same scenes and starts with the natural walk alone: waist and arms do as in the clip, whatever is there."
    )


def _everything_words(table: Table1) -> str:
    return (
        f"A crossing that failed counts with the whole {table.settings.limit:g} s. Rates have Wilson intervals, means "
        "Student's t, checks for each call the percentile bootstrap over trials."
    )


def _section(heading: str, words: str, *content: str) -> str:
    return tag("section", tag("h2", escape(heading)), tag("p", escape(words), class_="words"), *content)


def _made(about: Mapping[str, Any]) -> str:
    planners = [
        tag("li", escape(f"{name}: " + ", ".join(f"{key} {_setting(value)}" for key, value in chosen.items())))
        for name, chosen in about["planner_settings"].items()
    ]
    known = about["identity"]
    rows = (
        tag("p", "Made with ", tag("code", escape(about["command"]))),
        tag("ul", *planners) if planners else "",
        tag(
            "p",
            escape(
                f"elbowroom {known['version']}, program {known['program'][:12]}, avatar {known['avatar']['name']} "
                f"({known['avatar']['sha256'][:12]}), key frames {known['interval']:g} s apart."
            ),
        ),
    )
    return tag("footer", *rows)


def _setting(value: object) -> str:
    if isinstance(value, Mapping):
        return "(" + ", ".join(f"{key} {_setting(item)}" for key, item in value.items()) + ")"
    return str(value)


def _many(number: int) -> str:
    return f"{number:,}".replace(",", " ")
