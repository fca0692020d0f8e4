"""The mean stride of each joint as pictures, beside what is published."""

from collections.abc import Sequence

import numpy as np

from elbowroom.experiment.motion.angles import JOINTS
from elbowroom.experiment.motion.cycles import PARTS
from elbowroom.experiment.motion.published import KNEE, KNEE_DEVIATION, PELVIC_TILT, corridors
from elbowroom.experiment.motion.report import Gait, MotionReport
from elbowroom.experiment.report.svg import label, points, tag

_WIDTH, _HEIGHT = 480.0, 320.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 44.0, 12.0, 28.0, 30.0
_RANGES = {"hip": (-30.0, 50.0), "knee": (-10.0, 80.0), "ankle": (-30.0, 30.0)}  # degrees
_COLOURS = ("#0a6ebd", "#c2410c", "#15803d", "#7e22ce", "#a16207")
_STYLE = "text{font:11px system-ui,sans-serif}.grid{stroke:#ddd}.band{fill:#0a6ebd22}.range{stroke:#555;stroke-width:3}"


def motion_plots(report: MotionReport) -> dict[str, str]:
    """SVG documents: hip, knee and ankle over a stride, a line for each speed."""
    return {joint: _plot(joint, report.gaits) for joint in JOINTS} if report.gaits else {}


def _x(part: float) -> float:
    return _LEFT + part * (_WIDTH - _LEFT - _RIGHT)


def _y(value: float, joint: str) -> float:
    low, high = _RANGES[joint]
    inside = min(max(value, low), high)
    return _HEIGHT - _BOTTOM - (inside - low) / (high - low) * (_HEIGHT - _TOP - _BOTTOM)


def _plot(joint: str, gaits: Sequence[Gait]) -> str:
    parts = [tag("style", _STYLE), label(f"{joint}, degrees over a stride from heel strike on", _LEFT, 16.0)]
    low, high = _RANGES[joint]
    for value in np.arange(low, high + 1.0, 10.0).tolist():
        y = _y(value, joint)
        parts.append(tag("line", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=y, y2=y, class_="grid"))
        parts.append(label(f"{value:g}", _LEFT - 6.0, y + 4.0, text_anchor="end"))
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        parts.append(label(f"{100 * part:g} %", _x(part), _HEIGHT - 12.0, text_anchor="middle"))
    parts += _published(joint)
    for place, gait in enumerate(gaits):
        parts += _line(joint, gait, place)
    return tag("svg", *parts, xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {_WIDTH:g} {_HEIGHT:g}", width=_WIDTH)


def _line(joint: str, gait: Gait, place: int) -> list[str]:
    curve, colour = getattr(gait.curves, joint), _COLOURS[place % len(_COLOURS)]
    places = [(_x(n / (PARTS - 1)), _y(value, joint)) for n, value in enumerate(curve)]
    return [
        tag("polyline", points=points(places), fill="none", stroke=colour, stroke_width="1.6"),
        label(f"{gait.speed:g} m/s", _WIDTH - _RIGHT - 4.0, _TOP + 14.0 * (place + 1), fill=colour, text_anchor="end"),
    ]


def _published(joint: str) -> list[str]:
    """The mean of the knee with two deviations, and the corridors as bars."""
    drawn = []
    if joint == "knee":
        edges = [(n, value + 2.0 * KNEE_DEVIATION) for n, value in enumerate(KNEE.tolist())]
        edges += [(n, value - 2.0 * KNEE_DEVIATION) for n, value in reversed(list(enumerate(KNEE.tolist())))]
        drawn.append(
            tag("polygon", points=points((_x(n / (PARTS - 1)), _y(v, joint)) for n, v in edges), class_="band")
        )
    shift = PELVIC_TILT if joint == "hip" else 0.0
    for part, low, high in zip(*corridors()[joint], strict=True):
        x, ends = _x(float(part)), (_y(float(low) - shift, joint), _y(float(high) - shift, joint))
        drawn.append(tag("line", x1=x, x2=x, y1=ends[0], y2=ends[1], class_="range"))
    return drawn
