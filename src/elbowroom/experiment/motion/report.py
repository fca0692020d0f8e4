"""`elbowroom bench motion`: all walks, all figures, and the bands that they are held against."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.motion import bands
from elbowroom.experiment.motion.bands import Band, at_least, at_most
from elbowroom.experiment.motion.borne import Borne
from elbowroom.experiment.motion.curves import Curves, curves
from elbowroom.experiment.motion.feet import Feet, FootTrack, feet, foot_tracks
from elbowroom.experiment.motion.gaps import Narrow, narrow, pass_gap
from elbowroom.experiment.motion.knees import Knees, flexions, knees
from elbowroom.experiment.motion.processor_time import ProcessorTime, processor_time
from elbowroom.experiment.motion.scripts import Script, scripts
from elbowroom.experiment.motion.settings import GAPS, STEADY, UNEVEN, MotionSettings
from elbowroom.experiment.motion.smooth import Smoothness, smoothness
from elbowroom.experiment.motion.sole import soles_of
from elbowroom.experiment.motion.trunk import Trunk, trunk
from elbowroom.experiment.motion.turning import head_lead
from elbowroom.experiment.motion.walked import RATE, Walked, joint_track, walk

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_TURN = "turn"
_NATURAL = (1.0, 1.5)  # m/s: the speeds for which trunk and curves have published figures


@dataclass(frozen=True)
class Gait:
    """A steady walk."""

    speed: float  # m/s
    cadence: float  # steps a minute
    stance_planned: float  # % of the stride
    stance_seen: float  # %
    trunk: Trunk
    curves: Curves
    wrist: Smoothness | None  # of the rougher one, as seen from the hips
    pelvis: Smoothness | None


@dataclass(frozen=True)
class MotionReport:
    """All figures."""

    avatar: str
    settings: MotionSettings
    feet: dict[str, Feet]  # by case
    knees: dict[str, Knees]  # by case
    gaits: tuple[Gait, ...]  # by speed
    narrow: Narrow | None
    head_lead: float | None  # seconds, at a turn by 90 degrees
    cost: ProcessorTime

    def as_dict(self) -> dict[str, Any]:
        """Settings, figures and bands."""
        rows = [asdict(band) | {"inside": band.inside} for band in self.bands()]
        return asdict(self) | {"bands": rows}

    def bands(self) -> tuple[Band, ...]:
        """The figures that people have published ranges for."""
        legs = chain(_of_feet(self.feet), *map(_of_knees, self.knees.items()))
        return tuple(chain(legs, *map(_of_gait, self.gaits), _of_narrow(self.narrow), _of_rest(self)))


def run(humanoid: Humanoid, settings: MotionSettings, tick: Callable[[int], None] = lambda _: None) -> MotionReport:
    """Walk and measure; `tick` hears how many walks are done."""
    soles, done = soles_of(humanoid), 0
    tracks: dict[str, list[FootTrack]] = {}
    bent: dict[str, list[Floats]] = {}
    gaits, lead = [], None
    for script in _chosen(settings):
        walked = walk(humanoid, script)
        tracks.setdefault(script.case, []).extend(own := foot_tracks(walked, soles))
        bent.setdefault(script.case, []).extend(flexions(walked, humanoid.skeleton))
        if script.case == STEADY:
            gaits.append(_gait(walked, humanoid, own))
        if script.case == _TURN:
            lead = head_lead(walked, humanoid.skeleton)
        tick(done := done + 1)
    passages = []
    for ratio in settings.ratios if settings.with_gaps else ():
        passages.append(pass_gap(humanoid, ratio))
        tick(done := done + 1)
    return MotionReport(
        avatar=humanoid.name,
        settings=settings,
        feet={case: feet(own) for case, own in tracks.items()},
        knees={case: knees(own) for case, own in bent.items()},
        gaits=tuple(gaits),
        narrow=narrow(humanoid, tuple(passages)) if passages else None,
        head_lead=lead,
        cost=processor_time(humanoid),
    )


def amount(settings: MotionSettings) -> int:
    """How many walks there will be."""
    return len(_chosen(settings)) + (len(settings.ratios) if settings.with_gaps else 0)


def _chosen(settings: MotionSettings) -> Sequence[Script]:
    named = [case for case in settings.cases if case != GAPS]
    return scripts(named, settings.speeds) if named or not settings.cases else ()


def _gait(walked: Walked, humanoid: Humanoid, tracks: Sequence[FootTrack]) -> Gait:
    span, skeleton = walked.settled(), humanoid.skeleton
    roots = walked.roots[span]
    joints = type(walked.joints)(walked.joints.positions[span], walked.joints.rotations[span])
    hips = joint_track(joints, skeleton, "hips")
    wrists = [smoothness(joint_track(joints, skeleton, f"{side}Hand") - hips, RATE) for side in ("left", "right")]
    planned = float(np.mean([_share(track.planned, roots[:, 6]) for track in tracks]))
    return Gait(
        speed=walked.script.speed,
        cadence=120.0 * float(roots[-1, 6] - roots[0, 6]) / ((len(roots) - 1) / RATE),
        stance_planned=100.0 * planned,
        stance_seen=100.0 * float(np.mean([_share(track.seen, roots[:, 6]) for track in tracks])),
        trunk=trunk(joints, skeleton, roots),
        curves=curves(joints, skeleton, roots[:, 6], planned),
        wrist=min((wrist for wrist in wrists if wrist), key=lambda wrist: wrist.sparc, default=None),
        pelvis=smoothness(hips, RATE),
    )


def _share(standing: Bools, phase: Floats) -> float:
    """The part of whole strides in which a foot stands."""
    whole = np.searchsorted(phase, phase[0] + np.floor(phase[-1] - phase[0]))
    return float(np.mean(standing[:whole]))


def _of_feet(found: dict[str, Feet]) -> Sequence[Band]:
    rows = []
    for case, own in found.items():
        most = 5.0 if case in UNEVEN else 2.0
        rows.append(at_most(f"{case}: slide of a standing foot, 99 %", own.as_planned.p99, most, "mm"))
        rows.append(at_most(f"{case}: slide of a foot that rests, 99 %", own.by_looks.p99, most, "mm"))
        rows.append(at_most(f"{case}: sole in the ground", own.in_ground, 3.0, "mm"))
        rows += _of_borne(case, own.borne) if case in UNEVEN else ()
    if STEADY in found:
        rows.append(Band(f"{STEADY}: clearance of the swinging foot", found[STEADY].clearance, 10.0, 25.0, "mm"))
    return rows


def _of_borne(case: str, found: Borne) -> Sequence[Band]:
    ways = (("down", found.down, bands.BORNE_DOWN), ("up", found.up, bands.BORNE_UP))
    return [
        at_least(f"{case}: ground under heel to ball, {name}", under.least, least, "%")
        for name, under, least in ways
        if under.stances
    ]


def _of_knees(named: tuple[str, Knees]) -> Sequence[Band]:
    case, found = named
    return (
        at_most(f"{case}: a knee's speed, 99 %", found.speed, bands.KNEE_SPEED, "deg/s"),
        at_most(f"{case}: a knee's acceleration, 99.5 %", found.acceleration, bands.KNEE_ACCELERATION, "deg/s2"),
    )


def _of_gait(gait: Gait) -> Sequence[Band]:
    at, share, seen = f"{gait.speed:g} m/s", bands.stance_share(gait.speed), gait.trunk
    within = bands.SHARE_WITHIN
    rows = [Band(f"{at}: stance", gait.stance_planned, share - within, share + within, "%")]
    if _NATURAL[0] <= gait.speed <= _NATURAL[1]:
        wrist_sparc = bands.wrist_sparc(120.0 / gait.cadence)
        rows += [
            Band(f"{at}: pelvis up and down", seen.up_down, 3.0, 5.0, "cm"),
            Band(f"{at}: pelvis side to side", seen.side, 3.0, 6.0, "cm"),
            Band(f"{at}: pelvis rotation", seen.rotation, 6.0, 12.0, "deg"),
            Band(f"{at}: pelvis list", seen.list, 4.0, 8.0, "deg"),
            Band(f"{at}: knee in loading", gait.curves.loading, 12.0, 22.0, "deg"),
            Band(f"{at}: humps of the knee in stance", float(gait.curves.humps), 1.0, 1.0, ""),
            Band(f"{at}: knee at toe-off", gait.curves.toe_off, 30.0, 45.0, "deg"),
            Band(f"{at}: knee in the swing", gait.curves.swing_peak, 55.0, 68.0, "deg"),
            at_least(f"{at}: knee at its straightest", gait.curves.least, 0.0, "deg"),
            at_least(f"{at}: knee within two deviations", 100.0 * gait.curves.inside, 95.0, "% of the stride"),
            *(
                at_most(f"{at}: {joint} beyond the published range", beyond, 0.0, "deg")
                for joint, beyond in gait.curves.outside.items()
            ),
            Band(f"{at}: wrist, SPARC", gait.wrist.sparc if gait.wrist else None, *wrist_sparc, ""),
            Band(f"{at}: wrist, log dimensionless jerk", gait.wrist.jerk if gait.wrist else None, -13.0, -11.5, ""),
            Band(f"{at}: pelvis, log dimensionless jerk", gait.pelvis.jerk if gait.pelvis else None, -12.0, -8.0, ""),
        ]
    return rows


def _of_narrow(found: Narrow | None) -> Sequence[Band]:
    if found is None:
        return ()
    roomy = [p.clearance for p in found.passages if p.ratio >= 1.1 - 1e-9 and p.clearance is not None]
    even = [p.speed for p in found.passages if abs(p.ratio - 1.0) < 1e-6]
    return (
        Band("gaps: shoulders begin to turn at", found.onset, 1.10, 1.30, "shoulder widths"),
        at_least("gaps: least clearance from 1.1 shoulder widths on", min(roomy, default=None), 4.0, "cm"),
        Band("gaps: speed through one of a shoulder width", _percent(even[0] if even else None), 70.0, 90.0, "%"),
    )


def _percent(share: float | None) -> float | None:
    return None if share is None else 100.0 * share


def _of_rest(report: MotionReport) -> Sequence[Band]:
    rows = [
        at_most("cost of a skeleton", report.cost.one, 50.0, "us"),
        at_most("cost of each of 256", report.cost.each_of_many, 5.0, "us"),
    ]
    if not report.settings.cases or _TURN in report.settings.cases:
        rows.append(Band("head before the way at a turn of 90 degrees", report.head_lead, 0.2, 1.0, "s"))
    return rows
