"""The rooms' order: an import points to the same room or to one below it."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import elbowroom
from sources import nodes_of

PACKAGE = Path(elbowroom.__file__).parent
ROOMS = [
    "geometry",
    "formats",
    "body",
    "clips",
    "world",
    "planning",
    "control",
    "export",
    "experiment",
    "dataset",
    "server",
    "film",
    "cluster",
    "cli",
]
# Of `planning/exact`, bottom to top.
CHAPTERS = ["memory", "lattice", "sweep", "group", "joint", "refine", "certificate", "plan"]
FOR_ALL = {
    "errors",
    "jit",
    "by_reference",
    "kernel_cache",
    "kernel_turns",
    "kernel_library",
    "kernel_bitcode",
    "kept_kernels",
    "kept_arrays",
}


def imported_modules(path: Path) -> Iterator[str]:
    for node in nodes_of(path):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            module = node.module or ""
            yield from ([f"elbowroom.{alias.name}" for alias in node.names] if module == "elbowroom" else [module])


def room_of(module: str) -> str | None:
    parts = module.split(".")
    return parts[1] if parts[0] == "elbowroom" and len(parts) > 1 else None


@pytest.mark.parametrize("room", ROOMS)
def test_imports_point_down(room: str) -> None:
    below = set(ROOMS[: ROOMS.index(room) + 1]) | FOR_ALL
    for path in (PACKAGE / room).rglob("*.py"):
        for module in imported_modules(path):
            target = room_of(module)
            if module.startswith("elbowroom") and target != "__version__":
                assert target in below, f"{path.relative_to(PACKAGE)} imports {module}, which is above {room}"


def test_chapters_of_the_exact_planner_point_down() -> None:
    """Its files beside the chapters are read by all of them (the settings) or read them all (the planner)."""
    exact = PACKAGE / "planning" / "exact"
    assert {path.name for path in exact.iterdir() if path.is_dir() and path.name != "__pycache__"} == set(CHAPTERS)
    for chapter in CHAPTERS:
        below = {"settings", *CHAPTERS[: CHAPTERS.index(chapter) + 1]}
        for path in (exact / chapter).rglob("*.py"):
            for module in imported_modules(path):
                if module.startswith("elbowroom.planning.exact."):
                    target = module.split(".")[3]
                    assert target in below, f"{path.relative_to(PACKAGE)} imports {module}, which is above {chapter}"


def test_every_folder_with_code_is_a_room() -> None:
    folders = {path.relative_to(PACKAGE).parts[0] for path in PACKAGE.glob("*/*.py")}
    assert folders == set(ROOMS)


def test_every_folder_is_named_on_the_architecture_page() -> None:
    page = (Path(__file__).parents[1] / "docs" / "architecture.md").read_text("utf-8")
    for init in PACKAGE.rglob("*/__init__.py"):
        assert f"{init.parent.name}/`" in page, init.parent.relative_to(PACKAGE)


def test_only_the_page_server_knows_the_network() -> None:
    wire = {"starlette", "uvicorn", "websockets", "socket", "asyncio"}
    for room in ROOMS[: ROOMS.index("server")]:
        for path in (PACKAGE / room).rglob("*.py"):
            assert not wire & {module.split(".")[0] for module in imported_modules(path)}, path


def test_nothing_below_the_experiment_reads_a_clock_to_decide() -> None:
    for room in ROOMS[: ROOMS.index("experiment")]:
        for path in (PACKAGE / room).rglob("*.py"):
            for node in nodes_of(path):
                if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "time":
                    assert node.attr == "perf_counter_ns", f"{path}: time.{node.attr}"
                if isinstance(node, ast.Attribute) and node.attr in {"now", "utcnow"}:
                    raise AssertionError(f"{path}: {node.attr}")


def _opaque_names(function: ast.FunctionDef) -> set[str]:
    """The parameters of a function that hold obstacles: `Nearby` or `Spans`."""
    return {
        argument.arg
        for argument in [*function.args.args, *function.args.kwonlyargs]
        if isinstance(argument.annotation, ast.Name) and argument.annotation.id in {"Nearby", "Spans"}
    }


def test_only_the_door_knows_how_obstacles_are_written_down() -> None:
    """Elsewhere rows of obstacles are handed on as they are: not taken apart, and their layout is not imported."""
    door = PACKAGE / "world" / "obstacles"
    for path in PACKAGE.rglob("*.py"):
        if path.is_relative_to(door):
            continue
        for node in nodes_of(path):
            if isinstance(node, ast.ImportFrom) and node.module == "elbowroom.world.obstacles.layout":
                assert {alias.name for alias in node.names} <= {"Nearby", "Spans"}, path
            if isinstance(node, ast.Attribute) and node.attr in {"rows", "hulls"}:
                inner = node.value
                assert not (isinstance(inner, ast.Attribute) and inner.attr in {"standing", "obstacles", "near"}), path
            if isinstance(node, ast.FunctionDef):
                opaque = _opaque_names(node)
                for part in ast.walk(node):
                    taken = part.value if isinstance(part, ast.Attribute | ast.Subscript) else None
                    assert not (isinstance(taken, ast.Name) and taken.id in opaque), f"{path}: {node.name}"
