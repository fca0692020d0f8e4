"""Takes the picture of a dataset's report: `python tools/make_walks_pictures.py WALKS [FOLDER]`.

`walks.png`: how near, how fast and in which postures is walked, what was drawn, and some walks from above.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from playwright.sync_api import sync_playwright

from elbowroom.dataset.report import write_report
from elbowroom.film.page import browser_path

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
NAME = "walks.png"
WIDTH, COLOURS = 1000, 64


def main(walks: Path, folder: Path) -> None:
    """Write the report of a dataset, and take its picture."""
    folder.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as beside, sync_playwright() as playwright:
        report = Path(beside) / "report.html"
        write_report(walks, report)
        browser = playwright.chromium.launch(executable_path=browser_path(), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH, "height": 800}, color_scheme="light")
        page.goto(report.as_uri())
        page.screenshot(path=folder / NAME, full_page=True)
        browser.close()
    with Image.open(folder / NAME) as picture:
        few = picture.convert("RGB").quantize(COLOURS)
    few.save(folder / NAME, optimize=True)
    print(folder / NAME)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else FOLDER)
