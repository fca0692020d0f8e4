"""Who may begin a session, by what was measured; and what Prometheus is told."""

from contextlib import ExitStack

import pytest
from prometheus_client import parser

from elbowroom.server.entrance.admission import AMONG, EACH, FIRST, MOST, Admission
from elbowroom.server.metrics import metrics_text
from elbowroom.server.sessions.meter import LATE, Histogram, Meter
from elbowroom.server.usage import process_usage

HERE, THERE = "127.0.0.1", "192.168.1.7"


class Clock:
    """Time and processor time, as told."""

    def __init__(self) -> None:
        self.now = self.spent = 100.0

    def pass_by(self, seconds: float, cores: float = 0.0) -> None:
        self.now += seconds
        self.spent += seconds * cores


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def meter(clock: Clock) -> Meter:
    return Meter(lambda: clock.now, lambda: clock.spent)


@pytest.fixture
def admission(meter: Meter, clock: Clock) -> Admission:
    return Admission(meter, 2.0, lambda: clock.now, AMONG)


def live(clock: Clock, meter: Meter, seconds: float, cores: float, late: float = 0.0) -> None:
    """Let seconds pass in which so many cores are busy and frames are so late."""
    for _ in range(round(2 * seconds)):
        clock.pass_by(0.5, cores)
        for _ in range(30):
            meter.frames.add(late)
        meter.look()


def filled(admission: Admission, clock: Clock, meter: Meter, each: float) -> int:
    """How many sessions are let in that come every second, each of which keeps `each` cores busy."""
    with ExitStack() as stack:
        for count in range(MOST + 1):
            if admission.refusal(HERE) is not None:
                return count
            stack.enter_context(admission.seat(HERE))
            live(clock, meter, 1.0, each * (count + 1))
    raise AssertionError("nobody was refused")


def test_as_many_as_the_cores_bear(admission: Admission, clock: Clock, meter: Meter) -> None:
    cheap, dear = filled(admission, clock, meter, 0.08), filled(admission, clock, meter, 0.3)
    assert 15 <= cheap <= 22  # 2 cores, of which 90 % are given away
    assert AMONG <= dear <= 7
    assert admission.sessions == 0


def test_a_crowd_that_comes_at_once_is_counted_before_it_is_measured(admission: Admission) -> None:
    with ExitStack() as stack:
        while admission.refusal(HERE) is None:
            stack.enter_context(admission.seat(HERE))
        assert admission.sessions == 18
        assert "18 sessions already" in (admission.refusal(HERE) or "")
    assert admission.refused == 2


def test_nobody_more_where_frames_are_late(admission: Admission, clock: Clock, meter: Meter) -> None:
    with admission.seat(HERE):
        live(clock, meter, 5.0, 0.2, late=2.0 * LATE)
        assert admission.refusal(HERE) is None  # fewer than are let in at all
        with admission.seat(HERE):
            assert admission.refusal(HERE) is not None
            live(clock, meter, 5.0, 0.2)
            assert admission.refusal(HERE) is None  # they are in time again


def test_nobody_more_where_plans_wait(admission: Admission, clock: Clock, meter: Meter) -> None:
    with admission.seat(HERE), admission.seat(HERE):
        live(clock, meter, 5.0, 0.2)
        assert admission.refusal(HERE) is None
        for _ in range(20):
            meter.planned(0.1, 0.01)
        clock.pass_by(1.0, 0.2)
        assert admission.refusal(HERE) is not None


def test_the_only_server_of_a_busy_machine_takes_a_few(clock: Clock, meter: Meter) -> None:
    alone = Admission(meter, 2.0, lambda: clock.now)
    assert filled(alone, clock, meter, 2.0) == FIRST


def test_one_machine_has_a_share(admission: Admission, clock: Clock, meter: Meter) -> None:
    with ExitStack() as stack:
        for _ in range(EACH):
            assert admission.refusal(THERE) is None
            stack.enter_context(admission.seat(THERE))
            live(clock, meter, 1.0, 0.1)
        assert "your machine" in (admission.refusal(THERE) or "")
        assert admission.refusal("192.168.1.8") is None
    assert admission.refusal(THERE) is None


def test_nobody_comes_while_the_server_ends(admission: Admission) -> None:
    admission.ending = True
    assert "about to end" in (admission.refusal(HERE) or "")


def test_a_histogram_counts_up_to_each_bound() -> None:
    histogram = Histogram(0.01, 0.1)
    for seconds in (0.005, 0.01, 0.05, 3.0):
        histogram.add(seconds)
    counts, total = histogram.read()
    assert counts == [2, 3, 4]
    assert total == pytest.approx(3.065)
    assert histogram.beyond(0.1) == (4, 1)


def test_prometheus_reads_the_metrics(admission: Admission, meter: Meter) -> None:
    meter.frames.add(0.002)
    meter.frames.add(0.3)
    with admission.seat(HERE):
        text = metrics_text(meter, admission, process_usage(), 300)
    families = {family.name: family for family in parser.text_string_to_metric_families(text)}
    assert families["elbowroom_sessions"].samples[0].value == 1.0
    assert families["elbowroom_frame_lateness_seconds"].type == "histogram"
    lateness = {
        sample.labels.get("le"): sample.value for sample in families["elbowroom_frame_lateness_seconds"].samples
    }
    assert (lateness["0.0025"], lateness["0.25"], lateness["+Inf"]) == (1.0, 1.0, 2.0)
    assert families["process_resident_memory_bytes"].samples[0].value > 1e6
