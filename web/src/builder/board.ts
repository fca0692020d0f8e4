/** The board: the plan from above or from the side, with a grid; all on it can be reached by Tab and worked by keys. */

import { text } from "../texts/texts";
import { boardKey } from "./board_keys";
import { gridLines } from "./grid";
import { resized } from "./handles";
import { turnedBy, moved, changed, yawOf, type Selected } from "./edits";
import type { Editor } from "./editor";
import { shapesOf, type BoardShape } from "./board_shapes";
import { inWorld, onBoard } from "./outline";
import { Pinch } from "./pinch";
import type { Vec2 } from "./plan";
import { wrapped } from "./turns";

const SVG = "http://www.w3.org/2000/svg";
const NEAREST = 0.5;
const FURTHEST = 400;
const WHEEL = 0.0011;

/** What a pointer that is down does. */
interface Drag {
  readonly kind: "move" | "turn" | "size" | "pan";
  readonly tag: string;
  /** Where on the board it went down, and what has been done of it. */
  from: Vec2;
  selected: Selected | null;
}

let drags = 0;

export class Board {
  readonly element = document.createElementNS(SVG, "svg");
  private readonly grid = group("grid");
  private readonly shapes = group("shapes");
  private middle: Vec2 = [0, -3];
  private width = 12;
  private drag: Drag | null = null;
  private readonly pinch = new Pinch();
  /** Where the tool in hand is used once the only finger is lifted. */
  private tap: Vec2 | null = null;
  private mark: readonly [number, number] | null = null;
  private fitted = false;

  constructor(private readonly editor: Editor) {
    const { element } = this;
    element.classList.add("board");
    element.setAttribute("tabindex", "0");
    element.setAttribute("role", "application");
    element.setAttribute("aria-label", text("build.board"));
    this.grid.setAttribute("aria-hidden", "true");
    element.append(this.grid, this.shapes);
    element.addEventListener("pointerdown", (event) => this.down(event));
    element.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"] as const) element.addEventListener(name, (event) => this.up(event));
    element.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    element.addEventListener("keydown", (event) => this.key(event));
    element.addEventListener("focusin", ({ target }) => this.focused(target));
    new ResizeObserver(() => (this.fitted ? this.draw() : this.fit())).observe(element);
  }

  /** The middle of what is shown, on the ground. */
  get center(): Vec2 {
    const [x, , z] = inWorld(this.editor.side, this.middle);
    return this.editor.side === "top" ? [x, z] : [0, z];
  }

  /** Marks a place: where the avatar got no further; null for none. */
  showMark(mark: readonly [number, number] | null): void {
    this.mark = mark;
  }

  /** Brings the whole plan into view. */
  fit(): void {
    const { plan, side } = this.editor;
    const { clientWidth, clientHeight } = this.element;
    if (clientWidth === 0) return;
    this.fitted = true;
    const spots: Vec2[] = [plan.start, plan.finish, ...plan.tour].map(({ x, z }) => onBoard(side, [x, 1, z]));
    const points = [...spots, ...plan.things.flatMap(({ center, track }) => [center, ...track.map((key) => key.center)]).map((at) => onBoard(side, at))];
    const [left, right] = [Math.min(...points.map(([u]) => u)), Math.max(...points.map(([u]) => u))];
    const [top, bottom] = [Math.min(...points.map(([, v]) => v)), Math.max(...points.map(([, v]) => v))];
    this.middle = [(left + right) / 2, (top + bottom) / 2];
    const aspect = clientWidth / Math.max(1, clientHeight);
    this.width = Math.max(right - left + 3, (bottom - top + 3) * aspect);
    this.draw();
  }

  zoom(factor: number): void {
    this.width = Math.min(FURTHEST, Math.max(NEAREST, this.width * factor));
    this.draw();
  }

  draw(): void {
    const { clientWidth, clientHeight } = this.element;
    if (clientWidth === 0) return;
    const height = (this.width * clientHeight) / clientWidth;
    const [u, v] = this.middle;
    this.element.setAttribute("viewBox", `${u - this.width / 2} ${v - height / 2} ${this.width} ${height}`);
    this.element.dataset["tool"] = this.editor.tool;
    this.grid.innerHTML = gridLines(this.middle, [this.width, height], this.editor.plan.ground, this.editor.side);
    this.lay(shapesOf(this.editor, this.width / clientWidth, this.mark));
  }

  /** Brings the elements up to date; those that stay keep the focus. */
  private lay(wanted: readonly BoardShape[]): void {
    const known = new Map([...this.shapes.children].map((child) => [(child as SVGElement).dataset["id"], child as SVGElement]));
    for (const [i, shape] of wanted.entries()) {
      const element = known.get(shape.id) ?? document.createElementNS(SVG, shape.tag);
      known.delete(shape.id);
      element.dataset["id"] = shape.id;
      for (const [name, value] of Object.entries(shape.attributes)) {
        if (element.getAttribute(name) !== value) element.setAttribute(name, value);
      }
      if (shape.tag === "text") element.textContent = shape.words ?? "";
      if (this.shapes.children[i] !== element) this.shapes.insertBefore(element, this.shapes.children[i] ?? null);
    }
    for (const element of known.values()) element.remove();
  }

  private pointOf({ clientX, clientY }: { clientX: number; clientY: number }): Vec2 {
    const { left, top, width, height } = this.element.getBoundingClientRect();
    const scale = this.width / width;
    return [this.middle[0] + (clientX - left - width / 2) * scale, this.middle[1] + (clientY - top - height / 2) * scale];
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0) return;
    const { editor } = this;
    const point = this.pointOf(event);
    const [x, , z] = inWorld(editor.side, point);
    const hit = event.target instanceof SVGElement ? event.target.dataset["id"] ?? "" : "";
    if (event.pointerType === "touch" && this.touch(event, [x, z])) return;
    if (editor.side === "top" && editor.use(x, z)) return;
    const selected = selectedOf(hit) ?? editor.selected;
    const kind = hit === "turn" || hit === "size" ? hit : selectedOf(hit) ? "move" : "pan";
    this.drag = { kind, tag: `drag ${++drags}`, from: point, selected };
    this.element.setPointerCapture(event.pointerId);
    if (kind === "move") editor.select(selected);
    else if (kind === "pan" && event.target === this.element) editor.select(null);
  }

  /** A finger more: whether it is the second of a pinch, or one that may use the tool in hand. */
  private touch({ pointerId, clientX, clientY }: PointerEvent, at: Vec2): boolean {
    const { editor, pinch } = this;
    pinch.down(pointerId, [clientX, clientY]);
    this.element.setPointerCapture(pointerId);
    this.tap = !pinch.on && editor.side === "top" && editor.tool !== "select" ? at : null;
    if (pinch.on) this.drag = null;
    return pinch.on || this.tap !== null;
  }

  private up({ type, pointerId }: PointerEvent): void {
    const { tap } = this;
    this.pinch.up(pointerId);
    this.drag = this.tap = null;
    if (tap && type === "pointerup") this.editor.use(...tap);
  }

  private move(event: PointerEvent): void {
    const pinched = this.pinch.move(event.pointerId, [event.clientX, event.clientY]);
    if (pinched) this.pull([pinched.from, pinched.to], 1 / pinched.apart);
    else this.dragged(event);
  }

  private dragged(event: PointerEvent): void {
    const { drag, editor } = this;
    if (!drag) return;
    const point = this.pointOf(event);
    if (drag.kind === "pan") {
      this.middle = [this.middle[0] - point[0] + drag.from[0], this.middle[1] - point[1] + drag.from[1]];
      this.draw();
    } else if (drag.kind === "move" && drag.selected) {
      const by: Vec2 = [editor.snapped(point[0] - drag.from[0]), editor.snapped(point[1] - drag.from[1])];
      if (by[0] === 0 && by[1] === 0) return;
      drag.from = [drag.from[0] + by[0], drag.from[1] + by[1]];
      editor.put(moved(editor.plan, drag.selected, inWorld(editor.side, by)), drag.tag);
    } else this.handled(drag, point);
  }

  /** Turns or resizes by a handle. */
  private handled({ kind, tag }: Drag, point: Vec2): void {
    const { editor } = this;
    const { selected, plan, thing, index } = editor;
    if (!selected || selected.what === "stop") return;
    const spot = selected.what === "start" ? plan.start : selected.what === "finish" ? plan.finish : null;
    const center = spot ?? { x: thing?.center[0] ?? 0, z: thing?.center[2] ?? 0 };
    const [x, , z] = inWorld("top", point);
    if (kind === "turn") {
      const now = spot ? spot.heading : thing ? yawOf(thing) : 0;
      const wanted = Math.round(Math.atan2(x - center.x, z - center.z) / (Math.PI / 36)) * (Math.PI / 36);
      editor.put(turnedBy(plan, selected, wrapped(wanted - now)), tag);
    } else if (selected.what === "finish") {
      const width = 2 * Math.max(0.2, editor.snapped(Math.hypot(x - center.x, z - center.z)));
      editor.put({ ...plan, finish: { ...plan.finish, width } }, tag);
    } else if (thing && index !== null) {
      editor.put(changed(plan, index, { shape: resized(thing, [x - center.x, z - center.z], (one) => editor.snapped(one)) }), tag);
    }
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const at: Vec2 = [event.clientX, event.clientY];
    this.pull([at, at], Math.exp(Math.max(-400, Math.min(400, event.deltaY)) * WHEEL));
  }

  /** Shows `factor` times as much, and what was at one place of the window, CSS pixels, at another. */
  private pull([from, to]: readonly [Vec2, Vec2], factor: number): void {
    const before = this.pointOf({ clientX: from[0], clientY: from[1] });
    this.width = Math.min(FURTHEST, Math.max(NEAREST, this.width * factor));
    const after = this.pointOf({ clientX: to[0], clientY: to[1] });
    this.middle = [this.middle[0] + before[0] - after[0], this.middle[1] + before[1] - after[1]];
    this.draw();
  }

  /** Takes a key that is the board's. */
  key(event: KeyboardEvent): void {
    if (!boardKey(event, this.editor, this)) return;
    event.preventDefault();
    event.stopPropagation();
  }

  private focused(target: EventTarget | null): void {
    const selected = target instanceof SVGElement ? selectedOf(target.dataset["id"] ?? "") : null;
    if (selected && JSON.stringify(selected) !== JSON.stringify(this.editor.selected)) this.editor.select(selected);
  }
}

/** What an element's id stands for. */
export function selectedOf(id: string): Selected | null {
  const [what, index, key] = id.split(" ");
  if (what === "start" || what === "finish") return { what };
  if ((what === "thing" || what === "stop") && index) return { what, index: Number(index) };
  return what === "key" && index && key ? { what, index: Number(index), key: Number(key) } : null;
}

function group(name: string): SVGGElement {
  const made = document.createElementNS(SVG, "g");
  made.setAttribute("class", name);
  return made;
}
