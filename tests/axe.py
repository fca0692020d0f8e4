"""axe-core in the page: what keeps people with other eyes and hands from using it."""

from pathlib import Path
from typing import Any

import pytest

SOURCE = Path(__file__).parent / "judges" / "node_modules" / "axe-core" / "axe.min.js"
GRAVE = ("serious", "critical")
_RUN = """
async () => {
  const { violations } = await axe.run(document, { resultTypes: ["violations"] });
  const placesOf = (nodes) => nodes.slice(0, 5).map(({ target }) => target.join(" "));
  return violations.map(({ id, impact, nodes }) => ({ id, impact, at: placesOf(nodes) }));
}
"""


def grave_barriers(page: Any) -> list[dict[str, Any]]:
    """What axe-core calls serious or critical in the page as it stands; skips where it is not installed."""
    if not SOURCE.is_file():
        pytest.skip("axe-core is not installed: run `npm ci` in tests/judges")
    if not page.evaluate("typeof axe === 'object'"):
        page.evaluate(SOURCE.read_text("utf-8"))
    found: list[dict[str, Any]] = page.evaluate(_RUN)
    return [one for one in found if one["impact"] in GRAVE]
