"""`elbowroom bench motion`: how a walk looks, beside published figures of people."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_folder
from elbowroom.cli.options.avatar import Avatar, Bones, Height, IncludeHair, chosen_avatar, settings_by
from elbowroom.cli.options.lists import names_in, numbers_in
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, print_row, progress_bar
from elbowroom.experiment.motion.settings import MotionSettings

if TYPE_CHECKING:
    from elbowroom.experiment.motion.feet import Feet
    from elbowroom.experiment.motion.gaps import PassedGap
    from elbowroom.experiment.motion.knees import Knees
    from elbowroom.experiment.motion.report import Gait, MotionReport

EXAMPLES = """Examples:  elbowroom bench motion  |  elbowroom bench motion --case steady --speed 1.1 --plots pictures
|  elbowroom bench motion --avatar alice.vrm --case start,stop --json"""


def motion(
    *,
    case: Annotated[
        list[str] | None,
        typer.Option("--case", "--cases", metavar="NAME,...", help="What to walk, such as steady,stop,gaps (all)."),
    ] = None,
    speed: Annotated[
        list[str] | None,
        typer.Option("--speed", "--speeds", metavar="N,...", help="Of the steady walks, m/s (0.5,0.8,1.1,1.4,2)."),
    ] = None,
    avatar: Avatar = None,
    bones: Bones = None,
    height: Height = None,
    include_hair: IncludeHair = False,
    plots: Annotated[Path | None, typer.Option(help="Folder for pictures of the leg's joints over a stride.")] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Walk scripted walks and measure them as a gait laboratory does: feet, hips, joints, smoothness, narrow gaps."""
    settings = _settings(case, speed)
    check_arguments(files=[avatar, bones])
    check_folder(plots)
    reading = settings_by(bones, height, include_hair)
    from elbowroom.experiment.machine import machine_kind
    from elbowroom.experiment.motion.report import amount, run

    humanoid = chosen_avatar(avatar, reading)
    compile_first(quiet=quiet)
    if plots is not None:
        _write(plots, {})
    with progress_bar("Walking", amount(settings), quiet) as bar:
        report = run(humanoid, settings, bar.move)
    if json:
        print_json({"machine": machine_kind()} | report.as_dict())
    else:
        _show(report)
    if plots is not None:
        from elbowroom.experiment.motion.plots import motion_plots

        _write(plots, motion_plots(report))


def _settings(case: list[str] | None, speed: list[str] | None) -> MotionSettings:
    cases = names_in(case or ())
    if speed is None:
        return MotionSettings(cases)
    return MotionSettings(cases, numbers_in("--speed", speed, "0.8,1.1"))


def _show(report: "MotionReport") -> None:
    for name, own in report.feet.items():
        print_row(f"{name}: feet", _feet(own) | {"knees": _knees(report.knees[name])})
    for gait in report.gaits:
        print_row(f"{gait.speed:g} m/s", _gait(gait))
    if report.narrow is not None:
        rows = {f"{p.ratio:g} ({100.0 * p.width:.0f} cm)": _passage(p) for p in report.narrow.passages}
        print_row(f"Gaps, in shoulder widths of {100.0 * report.narrow.shoulders:.0f} cm", rows)
    bands = report.bands()
    rows = {
        band.name: f"{_number(band.value)}, should be {band.wanted}" for band in bands if not band.inside
    }  # what is as it should be needs no words
    others = "; the others:" if rows else ""
    print_row(f"{len(bands) - len(rows)} of {len(bands)} figures are a person's{others}", rows)


def _passage(passage: "PassedGap") -> str:
    if passage.speed is None:
        return "not passed"
    share = 100.0 * passage.speed
    return f"shoulders turn {passage.turn:.0f} deg, {_number(passage.clearance)} cm clear, {share:.0f} % of the speed"


def _feet(own: "Feet") -> dict[str, str]:
    rows = {
        name: f"{found.median:.1f} mm (half), {found.p99:.1f} (99 %), {found.worst:.1f} (all), {found.stances} stances"
        for name, found in (("slide, as planned", own.as_planned), ("slide, by looks", own.by_looks))
    }
    ways = (("level", own.borne.level), ("up", own.borne.up), ("down", own.borne.down))
    under = [f"{way.mean:.0f} % {name} (least {way.least:.0f})" for name, way in ways if way.stances]
    return rows | {
        "in the ground": f"{own.in_ground:.1f} mm",
        "swing clears": f"{_number(own.clearance)} mm",
        "ground under heel to ball": ", ".join(under) or "no whole stance",
    }


def _knees(found: "Knees") -> str:
    return f"{found.speed:.0f} deg/s (99 %), {found.fastest:.0f} (all), {found.acceleration:,.0f} deg/s2 (99.5 %)"


def _gait(gait: "Gait") -> dict[str, str]:
    seen, knee = gait.trunk, gait.curves
    rows = {
        "cadence": f"{gait.cadence:.0f} steps a minute",
        "stance": f"{gait.stance_planned:.1f} % as planned, {gait.stance_seen:.1f} % by looks",
        "pelvis": f"{seen.up_down:.1f} cm up and down, {seen.side:.1f} cm aside, "
        f"{seen.rotation:.1f} deg rotation, {seen.list:.1f} deg list, {seen.ripple:.2f} m/s ripple",
        "thorax": f"{seen.thorax:.1f} deg rotation, {seen.against:+.1f} with the pelvis",
        "knee": f"{knee.loading:.0f} loading, {knee.straightest:.0f} late stance, {knee.toe_off:.0f} toe-off, "
        f"{knee.swing_peak:.0f} swing, {knee.humps} humps in stance, {100.0 * knee.inside:.0f} % inside",
    }
    for name, smooth in (("wrist", gait.wrist), ("pelvis' smoothness", gait.pelvis)):
        if smooth is not None:
            rows[name] = f"SPARC {smooth.sparc:.2f}, log dimensionless jerk {smooth.jerk:.2f}"
    return rows


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.3g}"


def _write(folder: Path, pictures: dict[str, str]) -> None:
    """The pictures as files; none yet: only the folder, so that a name that will not do is told at once."""
    from elbowroom.errors import InputError

    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, picture in pictures.items():
            (folder / f"motion_{name}.svg").write_text(picture, "utf-8")
    except OSError as error:
        raise InputError(f"{folder}: cannot write pictures there: {error.strerror}") from None
