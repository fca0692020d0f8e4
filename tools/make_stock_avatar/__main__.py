"""Command line: write the stock avatar and its capsules into the package, or to the path given and beside it."""

import json
import sys
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
    fit = fit_capsules(humanoid.skeleton, surface.samples)
    return json.dumps(fit_document(path.read_bytes(), humanoid.skeleton, fit), indent=1) + "\n"


if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else stock_avatar_path()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(stock_avatar())
    fit_path = path.with_name(stock_fit_path().name)
    if stock_fit(path.read_bytes(), Humanoid.load(path).skeleton) is None:  # those of the same avatar stay
        fit_path.write_text(_fit(path), "utf-8")
    elif fit_path != stock_fit_path():
        fit_path.write_bytes(stock_fit_path().read_bytes())
    print(f"{path}: {path.stat().st_size} bytes\n{fit_path}: {fit_path.stat().st_size} bytes")
