"""X_ITE in a headless browser: another reader of X3D and VRML, as a judge. It sees no network."""

import mimetypes
from pathlib import Path
from typing import Any

import pytest

DIST = Path(__file__).parent / "judges" / "node_modules" / "x_ite" / "dist"
HOME = "http://judge.test/"
_PAGE = '<!doctype html><script src="x_ite.min.js"></script><x3d-canvas style="width:64px;height:64px"></x3d-canvas>'

_JOINTS = """
async ([text, turns]) => {
  const browser = X3D.getBrowser();
  const scene = await browser.createX3DFromString(text);
  await browser.replaceWorld(scene);
  const found = [];
  const product = (a, b) => Array.from({ length: 16 }, (_, i) =>
    [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (i & 3)] * b[(i >> 2) * 4 + k], 0));
  const visit = (node, above) => {
    if (!node) return;
    const inner = node.getInnerNode();
    const joint = node.getTypeName().endsWith("Joint");
    if (joint && turns[found.length]) {
      const [x, y, z, angle] = turns[found.length];
      inner._rotation = new X3D.SFRotation(x, y, z, angle);
      inner.eventsProcessed();
    }
    const world = inner.getMatrix ? product(above, inner.getMatrix()) : above;
    if (joint) {
      const center = [...inner._center.getValue(), 1];
      const position = [0, 1, 2].map((i) => center.reduce((sum, value, k) => sum + value * world[4 * k + i], 0));
      found.push({ name: node.getName(), position });
    }
    for (const field of ["_skeleton", "_children"])
      for (const child of inner[field] ?? []) visit(child.getValue(), world);
  };
  for (const root of scene.rootNodes) visit(root.getValue(), [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
  return found;
}
"""

_TRIANGLES = """
async (text) => {
  const browser = X3D.getBrowser();
  const scene = await browser.createX3DFromString(text);
  await browser.replaceWorld(scene);
  return [...scene.rootNodes]
    .filter((node) => node.getNodeTypeName() === "Shape")
    .map((shape) => Array.from(shape.getValue().getGeometry().getVertices()));
}
"""


_MOVED = """
async ([text, fractions]) => {
  const browser = X3D.getBrowser();
  const scene = await browser.createX3DFromString(text);
  const timer = scene.getNamedNode("timer");
  timer.enabled = false;
  await browser.replaceWorld(scene);
  const product = (a, b) => Array.from({ length: 16 }, (_, i) =>
    [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (i & 3)] * b[(i >> 2) * 4 + k], 0));
  const shown = [];
  for (const fraction of fractions) {
    for (const node of scene.rootNodes)
      if (node.getNodeTypeName().endsWith("Interpolator")) node.set_fraction = fraction;
    await browser.nextFrame();
    await browser.nextFrame();
    const found = {};
    const visit = (node, above) => {
      const inner = node.getInnerNode();
      const world = inner.getMatrix ? product(above, inner.getMatrix()) : above;
      if (node.getTypeName() === "HAnimJoint") {
        const center = [...inner._center.getValue(), 1];
        found[inner._name.getValue()] =
          [0, 1, 2].map((i) => center.reduce((sum, value, k) => sum + value * world[4 * k + i], 0));
      }
      for (const field of ["_skeleton", "_children"])
        for (const child of inner[field] ?? []) visit(child.getValue(), world);
    };
    for (const root of scene.rootNodes)
      if (root.getNodeTypeName() === "HAnimHumanoid")
        visit(root.getValue(), [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    shown.push(found);
  }
  return { version: browser.version, shown };
}
"""


_THINGS = """
async ([text, moments]) => {
  const browser = X3D.getBrowser();
  const scene = await browser.createX3DFromString(text);
  for (const node of scene.rootNodes) if (node.getNodeTypeName() === "TimeSensor") node.enabled = false;
  await browser.replaceWorld(scene);
  const shown = [];
  for (const fractions of moments) {
    for (const [name, fraction] of Object.entries(fractions)) scene.getNamedNode(name).set_fraction = fraction;
    await browser.nextFrame();
    await browser.nextFrame();
    const found = [];
    for (const node of scene.rootNodes) {
      if (node.getNodeTypeName() !== "Transform") continue;
      const m = node.getValue().getMatrix();
      for (const shape of node.children) {
        if (shape.getNodeTypeName() !== "Shape") continue;
        const form = shape.geometry, drawn = shape.getValue().getGeometry();
        const { radius, height } = form;
        const round = { Sphere: [radius, radius, radius], Cylinder: [radius, height / 2, radius] };
        const half = round[form.getNodeTypeName()];  // it draws round ones by few corners
        const low = half?.map((size) => -size) ?? [...drawn.getMin()], high = half ?? [...drawn.getMax()];
        found.push([0, 1, 2, 3, 4, 5, 6, 7].map((k) => {
          const at = [0, 1, 2].map((axis) => ((k >> axis) & 1 ? high : low)[axis]);
          return [0, 1, 2].map((i) => at[0] * m[i] + at[1] * m[4 + i] + at[2] * m[8 + i] + m[12 + i]);
        }));
      }
    }
    shown.push(found);
  }
  return { version: browser.version, shown };
}
"""


class XIte:
    """A page with X_ITE in it."""

    def __init__(self, browser: Any) -> None:
        if not DIST.is_dir():
            pytest.skip("X_ITE is not installed: run `npm ci` in tests/judges")
        self._page = browser.new_page()
        self._page.route("**/*", self._answer)
        self._page.goto(HOME)
        self._page.evaluate("X3D()")

    def joints(self, text: str, turns: list[list[float]]) -> list[dict[str, Any]]:
        """Name and world position of every joint, in the order of the file; `turns` are rotations to set first."""
        found: list[dict[str, Any]] = self._page.evaluate(_JOINTS, [text, turns])
        return found

    def moved(self, text: str, fractions: list[float]) -> dict[str, Any]:
        """X_ITE's `version`, and `shown`: each joint's world position by its name, at parts of an animation's time."""
        found: dict[str, Any] = self._page.evaluate(_MOVED, [text, fractions])
        return found

    def things(self, text: str, moments: list[dict[str, float]]) -> dict[str, Any]:
        """X_ITE's `version`, and `shown`: the corners of the boxes round the Shapes of all Transforms, in order.

        A moment tells the fraction of each interpolator by its name.
        """
        found: dict[str, Any] = self._page.evaluate(_THINGS, [text, moments])
        return found

    def triangles(self, text: str) -> list[list[float]]:
        """For every Shape at the top of the scene its triangles' corners, four numbers each."""
        found: list[list[float]] = self._page.evaluate(_TRIANGLES, text)
        return found

    def close(self) -> None:
        """Close the page."""
        self._page.close()

    @staticmethod
    def _answer(route: Any) -> None:
        url = route.request.url
        path = DIST / url.removeprefix(HOME).partition("?")[0]
        if url == HOME:
            route.fulfill(body=_PAGE, content_type="text/html")
        elif url.startswith(HOME) and path.is_file():
            kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
            route.fulfill(body=path.read_bytes(), content_type=kind)
        else:
            route.abort()
