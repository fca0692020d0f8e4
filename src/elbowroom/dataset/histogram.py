"""How often values occur, counted file by file, and drawn as bars."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.report.svg import label, tag, title

Floats = NDArray[np.float64]

_WIDTH, _HEIGHT = 248.0, 168.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 10.0, 10.0, 24.0, 26.0


@dataclass(eq=False)
class Histogram:
    """Counts of values in `bins` equal parts of [low, high]; what lies beyond counts for the part at that end."""

    name: str
    unit: str
    low: float
    high: float
    ticks: tuple[float, ...]
    bins: int = 40
    counts: NDArray[np.int64] = field(init=False)

    def __post_init__(self) -> None:
        self.counts = np.zeros(self.bins, np.int64)

    def add(self, values: Floats) -> None:
        """Count some more."""
        parts = np.floor((np.clip(values, self.low, self.high) - self.low) / (self.high - self.low) * self.bins)
        self.counts += np.bincount(np.minimum(parts.astype(int), self.bins - 1), minlength=self.bins)

    def share(self, low: float, high: float) -> float:
        """The share of all values that lie in parts whose middles are within [low, high]."""
        middles = self.low + (np.arange(self.bins) + 0.5) * (self.high - self.low) / self.bins
        within = self.counts[(middles >= low) & (middles <= high)].sum()
        return float(within) / max(1, int(self.counts.sum()))

    def drawn(self) -> str:
        """An SVG element."""
        total, most = max(1, int(self.counts.sum())), max(1, int(self.counts.max()))
        wide, floor = (_WIDTH - _LEFT - _RIGHT) / self.bins, _HEIGHT - _BOTTOM
        parts = [title(f"{self.name}, {self.unit}"), label(f"{self.name}, {self.unit}", _LEFT, 13.0, class_="panel")]
        for place, count in enumerate(self.counts.tolist()):
            high = count / most * (floor - _TOP)
            first = self.low + place * (self.high - self.low) / self.bins
            words = title(f"{first:.3g} to {first + (self.high - self.low) / self.bins:.3g}: {count / total:.1%}")
            x, y = _LEFT + place * wide, floor - high
            parts.append(tag("rect", words, x=x, y=y, width=0.86 * wide, height=high, class_="bar"))
        parts.append(tag("line", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=floor, y2=floor, class_="grid"))
        for tick in self.ticks:
            x = _LEFT + (tick - self.low) / (self.high - self.low) * (_WIDTH - _LEFT - _RIGHT)
            parts.append(label(f"{tick:g}", x, _HEIGHT - 10.0, class_="tick", text_anchor="middle"))
        return tag("svg", *parts, viewBox=f"0 0 {_WIDTH:g} {_HEIGHT:g}", role="img", class_="plot")
