"""How the cost of a planning call grows, as pictures."""

import math
from collections.abc import Sequence

from elbowroom.experiment.bench.plan import CallCosts, PlanCallsReport
from elbowroom.experiment.report.chart import HEIGHT, WIDTH, Axis, Mark, Panel, Series, draw
from elbowroom.experiment.report.svg import tag

_STYLE = (
    ".plot{font:11px system-ui,sans-serif}.panel{font-weight:600;font-size:10px}.tick{fill:#666}.grid{stroke:#ddd}"
    ".line{fill:none;stroke:#0a6ebd;stroke-width:2}.mark{fill:#0a6ebd}.interval{stroke:#0a6ebd;stroke-width:1.5}"
)


def growth_plots(report: PlanCallsReport) -> dict[str, str]:
    """SVG documents: "horizon" and "obstacles"; dots are medians of the calls that search, bars reach to the 99th
    percentile of all."""
    settings = report.settings
    return {
        "horizon": _plot("ms a search, by key frames ahead", settings.horizons, report.by_horizon),
        "obstacles": _plot("ms a search, by posts at the lane", settings.obstacles, report.by_obstacles),
    }


def _plot(name: str, places: Sequence[int], costs: Sequence[CallCosts]) -> str:
    top = _round_up(max(cost.p99_ms for cost in costs))
    axis = Axis(0.0, top, ticks=tuple(top * part for part in (0.0, 0.25, 0.5, 0.75, 1.0)))
    marks = tuple(
        Mark(place, cost.search_median_ms, cost.search_median_ms, cost.p99_ms)
        for place, cost in zip(places, costs, strict=True)
    )
    panel = Panel(name, tuple(places), axis, (Series("exact", "planner0", marks),))
    drawn = draw(panel, "planning call").replace("<svg ", f'<svg width="{2 * WIDTH:g}" height="{2 * HEIGHT:g}" ', 1)
    return drawn.replace(">", f' xmlns="http://www.w3.org/2000/svg">{tag("style", _STYLE)}', 1)


def _round_up(value: float) -> float:
    """To 1, 2 or 4 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(max(value, 1e-6)))
    return next(step * power for step in (1.0, 2.0, 4.0, 10.0) if value <= step * power)
