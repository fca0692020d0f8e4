"""Prints the tables of `docs/experiment.md` from what `elbowroom table1` wrote.

Call: python tools/table1_markdown.py results/table1.json
"""

import json
import sys
from pathlib import Path
from typing import Any

HEAD = (
    "",
    "\\|Q\\|",
    "crossed",
    "straight",
    "stuck",
    "time, s",
    "calls",
    "found",
    "checks a call",
    "real time",
    "late",
)
COST_HEAD = (
    "",
    "\\|Q\\|",
    "crossed, 95 %",
    "straight, 95 %",
    "stuck, all",
    "time, all",
    "checks a call, all",
    "plan ms",
)


def main() -> None:
    """Print everything."""
    document = json.loads(Path(sys.argv[1]).read_text())
    print(f"Made with `{document['command']}`, {document['date']}, {document['machine']}.")
    for planner in document["settings"]["planners"]:
        cells = [cell for cell in document["cells"] if cell["planner"] == planner]
        print(f"\n### {planner}: over the crossings that succeeded, *the paper's figure in italics*\n")
        print_table(HEAD, [beside_paper(cell) for cell in cells])
        print(f"\n### {planner}: over all trials, with 95 % intervals\n")
        print_table(COST_HEAD, [over_all(cell) for cell in cells])
    print("\n### The plain walk, without planning of waist and arms\n")
    walks = document["canned_walk"]
    rows = [
        [w["scene"].upper(), w["trials"], w["touching_trials"], f"{w['share']:.0%}", f"{100 * w['deepest']:.1f}"]
        for w in walks
    ]
    print_table(
        ("", "walks", "that touch", "touching frames", "deepest, cm"), [[str(text) for text in row] for row in rows]
    )


def beside_paper(cell: dict[str, Any]) -> list[str]:
    """A row of the first table."""
    ours, paper = cell["passed"], cell["paper"]
    pairs = (
        (cell["pass_rate"]["value"], paper["pass_rate"], ".2f"),
        (cell["straight_rate"]["value"], paper["straight_rate"], ".2f"),
        (value(ours["stuck_times"]), paper["stuck_times"], ".1f"),
        (value(ours["time_s"]), paper["passed_time_s"], ".1f"),
        (value(ours["plans_total"]), paper["plans_total"], ".0f"),
        (value(ours["plan_success_rate"]), paper["plan_success_rate"], ".2f"),
        (value(ours["checks_per_plan"]), paper["checks_per_plan"], ".0f"),
    )
    texts = [f"{number(own, form)} *{number(theirs, form)}*" for own, theirs, form in pairs]
    realtime = {True: "yes", False: "no", None: "–"}
    texts.append(f"{realtime[cell['realtime']]} *{realtime[paper['realtime']]}*")
    return [cell["scene"].upper(), str(cell["queue_size"]), *texts, str(cell["late_frames"])]


def over_all(cell: dict[str, Any]) -> list[str]:
    """A row of the second table."""
    everything, plan = cell["all"], cell["plan_ms"]
    return [
        cell["scene"].upper(),
        str(cell["queue_size"]),
        bounded(cell["pass_rate"], ".2f"),
        bounded(cell["straight_rate"], ".2f"),
        bounded(everything["stuck_times"], ".1f"),
        bounded(everything["time_s"], ".1f"),
        bounded(everything["checks_per_plan"], ".0f"),
        f"{plan['median']:.1f}, {plan['p99']:.1f}, {plan['worst']:.0f}",
    ]


def value(estimate: dict[str, float] | None) -> float | None:
    """The middle of an estimate."""
    return None if estimate is None else estimate["value"]


def number(value: float | None, form: str) -> str:
    """A number, or a dash."""
    return "–" if value is None else format(value, form)


def bounded(estimate: dict[str, float] | None, form: str) -> str:
    """An estimate with its interval."""
    if estimate is None:
        return "–"
    return f"{estimate['value']:{form}} ({estimate['low']:{form}}–{estimate['high']:{form}})"


def print_table(head: tuple[str, ...], rows: list[list[str]]) -> None:
    """A Markdown table."""
    for cells in (head, ["---", *["--:"] * (len(head) - 1)], *rows):
        print("| " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
