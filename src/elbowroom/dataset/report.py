"""A dataset on one page: counts, histograms over all frames, some walks from above."""

from collections import Counter
from collections.abc import Callable
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from elbowroom.dataset.figures import Figures
from elbowroom.dataset.manifest import Manifest
from elbowroom.dataset.plan import plan
from elbowroom.dataset.shards import read_shard
from elbowroom.errors import InputError
from elbowroom.experiment.report.svg import tag

_PLANS = 12
_STYLE = (
    ".bar{fill:var(--s0)}.scene .way{stroke:var(--s0);stroke-width:2;stroke-dasharray:none}"
    ".scene .near{stroke:var(--warn);stroke-width:3;vector-effect:non-scaling-stroke}.scene .start{fill:var(--ink)}"
    ".walks{display:grid;grid-template-columns:repeat(auto-fit,minmax(200px,1fr));gap:18px}.walks figure{margin:0}"
    ".walks svg{background:var(--panel);border:1px solid var(--faint);border-radius:6px}"
    "table{border-collapse:collapse;font-size:14.5px}td,th{text-align:left;padding:2px 18px 2px 0}"
)


def write_report(folder: Path, out: Path, progress: Callable[[int, int], None] = lambda _, __: None) -> Figures:
    """Count over all files and write the page; raises `InputError` for a folder without a dataset."""
    manifest = Manifest.of(folder)
    figures, kinds, drawn = Figures(), Counter[tuple[str, str, str]](), list[dict[str, Any]]()
    walks = sum(shard.walks for shard in manifest.shards)
    chosen = set(np.random.default_rng(walks).permutation(walks)[:_PLANS].tolist())
    seen = 0
    for done, shard in enumerate(manifest.shards):
        progress(done, len(manifest.shards))
        for row in _rows(folder / shard.file):
            figures.add(row["q"], row["root"], row["clearance"])
            kinds.update([("places", row["place"], ""), ("walks", row["swing"], ""), ("steering", row["steering"], "")])
            kinds.update([("steering", row["steering"], "reached")] if row["reached"] else [])
            if seen in chosen:
                drawn.append(row)
            seen += 1
    progress(len(manifest.shards), len(manifest.shards))
    try:
        out.write_text(_page(manifest, figures, kinds, drawn), "utf-8")
    except OSError as error:
        raise InputError(f"{out}: cannot be written ({error.strerror})") from None
    return figures


def _rows(path: Path) -> list[dict[str, Any]]:
    names = ["walk", "place", "avatar", "swing", "steering", "reached", "frames", "fps", "scene"]
    table = read_shard(path)
    rows = [dict(row) for row in table.select(names).to_pylist()]
    for name in ("q", "root", "clearance"):
        for row, values in zip(rows, table.column(name).to_pylist(), strict=True):
            row[name] = np.array(values, np.float64)
    return rows


def _page(
    manifest: Manifest, figures: Figures, kinds: Counter[tuple[str, str, str]], drawn: list[dict[str, Any]]
) -> str:
    spec, shards = manifest.spec, manifest.shards
    walks, seconds = sum(one.walks for one in shards), sum(one.seconds for one in shards)
    left_out = sum(len(one.rejected) for one in shards)
    lead = (
        f"{walks} walks, {seconds / 60:.1f} minutes at {spec.fps} frames a second; {left_out} of {walks + left_out} "
        f"drawn were left out. In {figures.clearance.share(0.0, 5.0):.0%} of all frames something is nearer than 5 cm."
    )
    style = (files("elbowroom.experiment.report") / "report.css").read_text("utf-8") + _STYLE
    body = (
        tag("header", tag("h1", escape(spec.name)), tag("p", escape(lead), class_="lead")),
        _section("Over all frames", tag("div", *(one.drawn() for one in figures.all), class_="panels")),
        _section("What was drawn", _table(kinds)),
        _section("Some walks from above", tag("div", *map(_figure, drawn), class_="walks")),
    )
    head = f'<meta charset="utf-8"><title>{escape(spec.name)}</title><style>{style}</style>'
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head>\n<body><main>\n' + "\n".join(body) + "\n</main></body>\n"
    )


def _section(heading: str, content: str) -> str:
    return tag("section", tag("h2", escape(heading)), content)


def _table(kinds: Counter[tuple[str, str, str]]) -> str:
    rows = [tag("tr", *(tag("th", name) for name in ("", "", "walks", "finish reached")))]
    for (list_name, name, more), count in sorted(kinds.items()):
        if not more:
            reached = kinds[list_name, name, "reached"] if list_name == "steering" else None
            cells = (list_name, name, str(count), "" if reached is None else str(reached))
            rows.append(tag("tr", *(tag("td", escape(cell)) if cell else "<td></td>" for cell in cells)))
    return tag("table", *rows)


def _figure(row: dict[str, Any]) -> str:
    words = f"{row['walk']}: {row['place']}, {row['steering']}, {row['frames'] / row['fps']:.1f} s"
    picture = plan(row["scene"], row["root"], row["clearance"], words)
    return tag("figure", picture, tag("figcaption", escape(words)))
