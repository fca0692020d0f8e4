"""Command line: write the stock avatar and its capsules into the package, or to the path given and beside it.

Capsules of the same avatar stay as they are, but for those that are named after `--anew` (`--anew Hand Forearm`).
"""

import argparse
import json
from pathlib import Path

from elbowroom.body.fitting.fit import fit_capsules
from elbowroom.body.fitting.stock_fit import fit_document, stock_fit
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_with_surface
from elbowroom.body.stock import stock_avatar_path, stock_fit_path
from make_stock_avatar.assemble import stock_avatar


def _fit(path: Path) -> str:
    """The fit of an avatar file as JSON, made anew."""
    humanoid, surface = load_with_surface(path)
    fit = fit_capsules(humanoid.skeleton, surface)
    return json.dumps(fit_document(path.read_bytes(), humanoid.skeleton, fit), indent=1) + "\n"


def _with_anew(path: Path, ends: tuple[str, ...]) -> str:
    """The stored fit of an avatar file as JSON, with the capsules whose names end so made anew."""
    stored, made = json.loads(stock_fit_path().read_text("utf-8")), json.loads(_fit(path))
    parts = [row["name"].split()[0] for row in made["capsules"]]
    if unknown := [end for end in ends if not any(part.endswith(end) for part in parts)]:
        raise SystemExit(f"--anew: no capsule's name ends in {unknown[0]}; there are {', '.join(dict.fromkeys(parts))}")
    rows = []
    for part in dict.fromkeys(parts):
        of = made if part.endswith(ends) else stored
        rows += [row for row in of["capsules"] if row["name"].split()[0] == part]
    return json.dumps({**stored, "capsules": rows}, indent=1) + "\n"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("path", type=Path, nargs="?", default=stock_avatar_path())
    parser.add_argument("--anew", nargs="+", default=(), metavar="PART")
    arguments = parser.parse_args()
    path: Path = arguments.path
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(stock_avatar())
    fit_path = path.with_name(stock_fit_path().name)
    if stock_fit(path.read_bytes(), Humanoid.load(path).skeleton) is None:  # those of the same avatar stay
        fit_path.write_text(_fit(path), "utf-8")
    elif arguments.anew:
        fit_path.write_text(_with_anew(path, tuple(arguments.anew)), "utf-8")
    elif fit_path != stock_fit_path():
        fit_path.write_bytes(stock_fit_path().read_bytes())
    print(f"{path}: {path.stat().st_size} bytes\n{fit_path}: {fit_path.stat().st_size} bytes")
