"""`elbowroom doctor`: what is installed, what is compiled, and what a live session costs."""

import os
import platform
import tempfile
import zipfile
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated, Any
from urllib.parse import urlsplit

import typer

from elbowroom.cli.doctor.soak_text import soak_faults, soak_rows, telling
from elbowroom.cli.options.answers import Json
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.telling.output import print_json
from elbowroom.errors import InputError

EXAMPLES = """Examples:  elbowroom doctor  |  elbowroom doctor --session --scene d --sessions 4 --seconds 20 --json  |
elbowroom doctor --load 16"""

_PACKAGES = ("numpy", "numba", "scipy", "starlette", "uvicorn", "websockets", "typer", "rich")
WHEEL_BUDGET_MB = 5.0


def doctor(
    *,
    session: Annotated[bool, typer.Option("--session", help="Measure the cost of live sessions.")] = False,
    sessions: Annotated[int, typer.Option(min=1, max=8, help="How many live sessions at once.")] = 1,
    seconds: Annotated[float, typer.Option(min=2.0, max=600.0, help="How long to measure.")] = 10.0,
    scene: Annotated[str, typer.Option(help="The scene of the measured session.")] = "a",
    startup: Annotated[bool, typer.Option("--startup", help="Measure how long a start takes.")] = False,
    first_run: Annotated[bool, typer.Option("--first-run", help="And the first one, with all to compile.")] = False,
    soak: Annotated[
        float | None,
        typer.Option(metavar="MINUTES", min=0.2, max=1440.0, help="Whether memory stays, with clients good and bad."),
    ] = None,
    clients: Annotated[
        int, typer.Option(min=1, max=8, help="How many come and go at a time in a soak; 2 take half a core.")
    ] = 2,
    load: Annotated[
        int | None, typer.Option(metavar="N", min=1, max=1000, help="Whether N users who steer are served in time.")
    ] = None,
    at: Annotated[str | None, typer.Option(metavar="URL", help="Load this server, not one of its own.")] = None,
    json: Json = False,
) -> None:
    """Look the installation over. Exit code 0: all well, 1: a budget is exceeded or something is missing."""
    check_arguments(scenes=[scene])
    if at is not None:
        _check_address(at)
    from rich.console import Console

    facts = installation_facts()
    if session:
        from elbowroom.cli.doctor.session_cost import measure_session

        with Console(stderr=True).status(f"Measuring live sessions for {seconds:g} s ..."):
            facts["session"] = asdict(measure_session(seconds, scene, sessions))
    if startup or first_run:
        from elbowroom.cli.doctor.startup import measure_startup

        with Console(stderr=True).status("Starting programs and servers ..."):
            facts["startup"] = asdict(measure_startup(scene, 3, first_run=first_run))
    if soak is not None:
        from elbowroom.cli.doctor.soak import soak as soaked

        with telling(soak) as tell:
            facts["soak"] = asdict(soaked(soak, clients, tell))
    if load is not None:
        from elbowroom.cli.doctor.load import measure_load

        with Console(stderr=True).status(f"{load} users steer for {seconds:g} s ..."):
            facts["load"] = asdict(measure_load(load, seconds, at))
    faults = _faults(facts)
    facts["faults"] = faults
    if json:
        print_json(facts)
    else:
        typer.echo(_as_text(facts))
    if faults:
        raise typer.Exit(1)


def _check_address(url: str) -> None:
    """Raises `InputError` for what cannot be the address of a server."""
    try:
        parts = urlsplit(url)
        known = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
    except ValueError:  # no port, or no address of the sixth version
        known = False
    if not known:
        raise InputError(f"--at {url[:80]}: is no address of a server, such as http://127.0.0.1:8765")


def installation_facts() -> dict[str, Any]:
    """What can be said without running anything."""
    from elbowroom import __version__
    from elbowroom.server.app import client_folder, client_is_built

    return {
        "elbowroom": __version__,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "packages": {name: _version(name) for name in _PACKAGES},
        "processor": _processor(),
        "kernels": _kernels(),
        "client": {"built": client_is_built(), "megabytes": _megabytes(client_folder())},
        "wheel": _wheel(),
    }


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _processor() -> dict[str, Any]:
    import llvmlite.binding

    features = llvmlite.binding.get_host_cpu_features()
    widths = {"avx512f": 512, "avx2": 256, "avx": 256, "neon": 128, "sse2": 128}
    bits = next((bits for feature, bits in widths.items() if features.get(feature)), 0)
    return {"name": llvmlite.binding.get_host_cpu_name(), "cores": os.cpu_count(), "vector_bits": bits}


def _kernels() -> dict[str, Any]:
    """How many kernels there are, how many of them are compiled already, and where they are kept."""
    import elbowroom.server.sessions.session  # noqa: F401  (brings in every module that has kernels)
    from elbowroom.server.kernels.kernel_cache import cache_folders, kept_kernels, kernels

    return {"known": len(kernels()), "kept": len(kept_kernels()), "folders": cache_folders()}


def _wheel() -> dict[str, Any]:
    """The newest wheel in `dist/` of this checkout or this folder; without one, what a wheel would weigh."""
    from elbowroom.server.app import client_folder

    places = [client_folder().parents[2] / "dist", Path.cwd() / "dist"]
    wheels = [wheel for place in places for wheel in place.glob("elbowroom-*.whl")]
    if not wheels:
        return {"file": None, "megabytes": _packed_megabytes(), "budget_megabytes": WHEEL_BUDGET_MB}
    newest = max(wheels, key=lambda wheel: wheel.stat().st_mtime)
    return {"file": newest.name, "megabytes": _megabytes(newest), "budget_megabytes": WHEEL_BUDGET_MB}


def _packed_megabytes() -> float:
    """The installed package as a compressed archive, which is what a wheel is."""
    package = Path(__file__).parents[2]
    with tempfile.TemporaryFile() as scratch:
        with zipfile.ZipFile(scratch, "w", zipfile.ZIP_DEFLATED) as archive:
            for file in package.rglob("*"):
                if file.is_file() and "__pycache__" not in file.parts:
                    archive.write(file, file.relative_to(package.parent))
        return round(scratch.tell() / 1e6, 2)


def _megabytes(path: Path) -> float:
    files = [path] if path.is_file() else [file for file in path.rglob("*") if file.is_file()]
    return round(sum(file.stat().st_size for file in files) / 1e6, 2)


def _faults(facts: dict[str, Any]) -> list[str]:
    faults = [f"package {name} is missing" for name, found in facts["packages"].items() if found is None]
    if not facts["client"]["built"]:
        from elbowroom.server.app import HOW_TO_BUILD

        faults.append(HOW_TO_BUILD)
    if facts["wheel"]["megabytes"] > WHEEL_BUDGET_MB:
        faults.append(f"the wheel is larger than {WHEEL_BUDGET_MB:g} MB")
    cost = facts.get("session")
    if cost and cost["cpu_percent"] > cost["cpu_budget_percent"]:
        faults.append("a live session needs more processor time than its budget")
    if cost and cost["own_megabytes"] > cost["own_budget_megabytes"]:
        faults.append("the server of these sessions needs more memory than its budget")
    start = facts.get("startup")
    if start and start["program_seconds"] > start["warm_budget_seconds"]:
        faults.append("the first plan of a program comes later than its budget")
    if start and (start["first_run_seconds"] or 0.0) > start["first_run_budget_seconds"]:
        faults.append("the first run takes longer than its budget")
    return faults + soak_faults(facts.get("soak")) + _load_faults(facts.get("load"))


def _load_faults(load: dict[str, Any] | None) -> list[str]:
    from elbowroom.cli.doctor.load import Load, load_faults

    return [] if load is None else load_faults(Load(**load))


def _as_text(facts: dict[str, Any]) -> str:
    processor, kernels, client, wheel = facts["processor"], facts["kernels"], facts["client"], facts["wheel"]
    rows = [
        ("elbowroom", f"{facts['elbowroom']} on Python {facts['python']}, {facts['system']}"),
        ("packages", ", ".join(f"{name} {found or 'MISSING'}" for name, found in facts["packages"].items())),
        ("processor", f"{processor['name']}, {processor['cores']} cores, vectors of {processor['vector_bits']} bits"),
        ("kernels", f"{kernels['kept']} of {kernels['known']} compiled and kept in {_where(kernels['folders'])}"),
        ("page", f"built, {client['megabytes']} MB" if client["built"] else "not built"),
        ("wheel", f"{wheel['file'] or 'packed from here'}, {wheel['megabytes']} MB (budget {WHEEL_BUDGET_MB:g})"),
        *_session_rows(facts.get("session")),
        *_startup_rows(facts.get("startup")),
        *soak_rows(facts.get("soak")),
        *_load_rows(facts.get("load")),
        *(("fault", fault) for fault in facts["faults"]),
    ]
    return "\n".join(f"{name:<10} {text}" for name, text in rows)


def _where(folders: list[str]) -> str:
    """Folders as one would tell them: numba keeps the kernels of each source in one of its own."""
    if len(folders) < 2:
        return folders[0] if folders else "no place: none can be written to"
    return f"{len(folders)} folders of {os.path.commonpath(folders)}"


def _session_rows(cost: dict[str, Any] | None) -> list[tuple[str, str]]:
    if cost is None:
        return []
    cpu = f"{cost['cpu_percent']:.1f} % of one core (budget {cost['cpu_budget_percent']:g})"
    own = f"{cost['own_megabytes']:.0f} MB of its own (budget {cost['own_budget_megabytes']:g})"
    memory = f"{own}, {cost['resident_megabytes']:.0f} with its libraries"
    rate = f"{cost['frames_per_second']:.1f} frames/s, computing one takes {cost['frame_ms_p50']:.2f} ms"
    frames = f"99 % of the frames within {cost['late_ms_p99']:.1f} ms of their time"
    half, most, longest = (f"{cost[f'answer_ms_{name}']:.0f}" for name in ("p50", "p99", "max"))
    answers = f"commands answered within {half} ms (half), {most} (99 %), {longest} (all"
    return [
        ("session", f"{cost['sessions']} at once: {cpu} each, {memory}"),
        ("", f"{rate} (95 %: {cost['frame_ms_p95']:.2f}); page ready {cost['ready_seconds']:.1f} s after the start"),
        ("", f"{frames}; {answers}; aim {cost['answer_aim_ms']:g}); {cost['late_plans']} plans too late"),
    ]


def _load_rows(load: dict[str, Any] | None) -> list[tuple[str, str]]:
    if load is None:
        return []
    frames = (
        f"{load['frames_per_second']:.1f} frames/s each, {load['on_time_percent']:.2f} % of them in time (budget 99)"
    )
    half, budget, prompt = load["answer_ms_p50"], load["answer_budget_ms"], load["answered_in_time_percent"]
    answers = f"{prompt:.1f} % of commands answered within {budget:g} ms (budget 99), half of them within {half:.0f}"
    processor = f"{load['cpu_percent']:.1f} % of one core and {load['own_megabytes']:.1f} MB each"
    clients = f"the users themselves took {load['clients_cpu_percent']:.0f} % of one core"
    return [
        ("load", f"{load['served']} of {load['sessions']} users served for {load['seconds']:.0f} s: {frames}"),
        ("", f"{answers}; {processor}; {clients}"),
    ]


def _startup_rows(start: dict[str, Any] | None) -> list[tuple[str, str]]:
    if start is None:
        return []
    program = f"{start['program_seconds']:.1f} s ({start['program_cpu_seconds']:.1f} s of a processor)"
    rows = [
        ("start", f"first plan of a program after {program}, budget {start['warm_budget_seconds']:g} s"),
        ("", f"first plan on the page {start['page_seconds']:.1f} s after the server's start"),
    ]
    if start["first_run_seconds"] is not None:
        first = f"{start['first_run_seconds']:.0f} s, budget {start['first_run_budget_seconds']:g} s"
        rows.append(("", f"the same with all kernels to compile: {first}"))
    return rows
