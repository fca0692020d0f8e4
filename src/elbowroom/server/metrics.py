"""The server's counts in the text format that Prometheus reads (version 0.0.4)."""

from collections.abc import Iterator, Mapping

from elbowroom.server.entrance.admission import Admission
from elbowroom.server.sessions.meter import Histogram, Meter
from elbowroom.server.usage import Usage

CONTENT_TYPE = "text/plain; version=0.0.4; charset=utf-8"


def metrics_text(meter: Meter, admission: Admission, usage: Usage, kernels: int) -> str:
    """All of them, with what they mean."""
    return "\n".join(_lines(meter, admission, usage, kernels)) + "\n"


def joined_metrics(texts: Mapping[str, str]) -> str:
    """Texts of `metrics_text` by the names of their servers, as one: each count with its server as a label."""
    heads, counts = dict[str, list[str]](), dict[str, list[str]]()
    for server, text in texts.items():
        family = ""
        for line in text.splitlines():
            if line.startswith("#"):
                family = line.split(" ")[2]
                told = heads.setdefault(family, [])
                told += [line] if line not in told else []
            else:
                name, value = line.rsplit(" ", 1)
                bare, _, labels = name.partition("{")
                others = f",{labels}" if labels else "}"
                counts.setdefault(family, []).append(f'{bare}{{server="{server}"{others} {value}')
    return "".join(f"{line}\n" for family, head in heads.items() for line in (*head, *counts.get(family, ())))


def _lines(meter: Meter, admission: Admission, usage: Usage, kernels: int) -> Iterator[str]:
    yield from _number("elbowroom_sessions", "gauge", "Sessions that are shown now.", admission.sessions)
    yield from _number("elbowroom_sessions_refused_total", "counter", "Sessions refused.", admission.refused)
    yield from _histogram(
        "elbowroom_frame_lateness_seconds", "How long after it was due a frame was ready.", meter.frames
    )
    yield from _histogram("elbowroom_answer_seconds", "From a new command to a motion planned for it.", meter.answers)
    yield from _histogram("elbowroom_plan_seconds", "How long a plan took.", meter.plans)
    yield from _number("process_cpu_seconds_total", "counter", "Processor time of all threads.", usage.cpu_seconds)
    resident = "Memory held, with the files of libraries."
    yield from _number("process_resident_memory_bytes", "gauge", resident, usage.resident_bytes)
    yield from _number("elbowroom_own_memory_bytes", "gauge", "Memory held, without files.", usage.own_bytes)
    yield from _number("elbowroom_kernels", "gauge", "Compiled kernels in memory.", kernels)


def _number(name: str, kind: str, meaning: str, value: float) -> Iterator[str]:
    yield from _head(name, kind, meaning)
    yield f"{name} {value!r}"


def _histogram(name: str, meaning: str, histogram: Histogram) -> Iterator[str]:
    counts, total = histogram.read()
    yield from _head(name, "histogram", meaning)
    for bound, count in zip((*map(repr, histogram.bounds), "+Inf"), counts, strict=True):
        yield f'{name}_bucket{{le="{bound}"}} {count}'
    yield f"{name}_sum {total!r}"
    yield f"{name}_count {counts[-1]}"


def _head(name: str, kind: str, meaning: str) -> Iterator[str]:
    yield f"# HELP {name} {meaning}"
    yield f"# TYPE {name} {kind}"
