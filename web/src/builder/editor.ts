/** The state of build mode: the plan with its history, what is selected, which tool is in hand. Nothing is drawn here. */

import * as edits from "./edits";
import type { Selected } from "./edits";
import { History } from "./history";
import type { Side } from "./outline";
import type { Plan, Thing, Vec3 } from "./plan";
import type { Kind } from "./shapes";

/** What a click on the board does. */
export type Tool = "select" | "track" | "stop" | Kind;

/** Metres; 0 is without. */
export const SNAPS = [0, 0.01, 0.05, 0.1, 0.25, 0.5] as const;
/** Radians that a key or a turning handle goes at a time. */
export const TURN_STEP = Math.PI / 12;
const FINE = 0.01;
const GROWTH = 1.1;

export class Editor {
  tool: Tool = "select";
  side: Side = "top";
  snap: number = 0.1;
  selected: Selected | null = null;
  private history: History<Plan>;

  /** @param changed called after each change, of the plan or of anything else here */
  constructor(plan: Plan, private readonly titleOf: (kind: Kind) => string, private readonly changed: () => void) {
    this.history = new History(plan);
  }

  get plan(): Plan {
    return this.history.present;
  }

  get canUndo(): boolean {
    return this.history.canUndo;
  }

  get canRedo(): boolean {
    return this.history.canRedo;
  }

  /** The thing that is selected, itself or by a point of its track. */
  get thing(): Thing | null {
    const { index } = this;
    return index === null ? null : (this.plan.things[index] ?? null);
  }

  get index(): number | null {
    const { selected } = this;
    return selected && (selected.what === "thing" || selected.what === "key") ? selected.index : null;
  }

  /** Begins anew with another plan. */
  open(plan: Plan): void {
    this.history = new History(plan);
    this.selected = null;
    this.tool = "select";
    this.changed();
  }

  select(selected: Selected | null): void {
    this.selected = selected;
    if (this.index === null && this.tool === "track") this.tool = "select";
    this.changed();
  }

  take(tool: Tool): void {
    this.tool = tool === "track" && this.index === null ? "select" : tool;
    this.changed();
  }

  look(side: Side): void {
    this.side = side;
    this.changed();
  }

  snapTo(metres: number): void {
    this.snap = metres;
    this.changed();
  }

  undo(): void {
    this.history.undo();
    this.keepSelection();
  }

  redo(): void {
    this.history.redo();
    this.keepSelection();
  }

  /** Puts a plan in place of the present one; see `History.put` for the tag. */
  put(plan: Plan | null, tag: string | null = null): void {
    if (!plan) return;
    this.history.put(plan, tag);
    this.keepSelection();
  }

  /** What the tool in hand does at a point on the ground; whether it did anything. */
  use(x: number, z: number): boolean {
    const { tool, plan } = this;
    if (tool === "select") return false;
    const [atX, atZ] = [this.snapped(x), this.snapped(z)];
    if (tool === "track") {
      if (this.index !== null) this.put(edits.extended(plan, this.index, atX, atZ));
    } else if (tool === "stop") this.stop(atX, atZ);
    else this.place(tool, atX, atZ);
    return true;
  }

  /** Places a new thing and selects it. */
  place(kind: Kind, x: number, z: number): void {
    const plan = edits.placed(this.plan, kind, x, z, this.titleOf(kind));
    if (!plan) return;
    this.tool = "select";
    this.selected = { what: "thing", index: plan.things.length - 1 };
    this.put(plan);
  }

  /** Adds a stop to the tour and selects it; the tool stays in hand. */
  stop(x: number, z: number): void {
    const plan = edits.stopped(this.plan, x, z);
    if (!plan) return;
    this.selected = { what: "stop", index: plan.tour.length - 1 };
    this.put(plan);
  }

  /** Moves the selected by steps of the snap; `many` goes ten of them. */
  nudge([x, y, z]: Vec3, many: boolean): void {
    const step = (this.snap || FINE) * (many ? 10 : 1);
    if (this.selected) this.put(edits.moved(this.plan, this.selected, [x * step, y * step, z * step]));
  }

  turn(steps: number): void {
    if (this.selected) this.put(edits.turnedBy(this.plan, this.selected, steps * TURN_STEP));
  }

  grow(steps: number): void {
    if (this.selected) this.put(edits.scaledBy(this.plan, this.selected, GROWTH ** steps));
  }

  copy(): void {
    if (this.index === null) return;
    const plan = edits.copied(this.plan, this.index, Math.max(this.snap, 0.5));
    if (plan) this.selected = { what: "thing", index: plan.things.length - 1 };
    this.put(plan);
  }

  remove(): void {
    if (this.selected) this.put(edits.removed(this.plan, this.selected));
  }

  /** Adds a point to the selected thing's track, a metre on: for who has no pointer. */
  extend(): void {
    const { thing, index } = this;
    if (!thing || index === null) return;
    const [x, , z] = thing.track[thing.track.length - 1]?.center ?? thing.center;
    const plan = edits.extended(this.plan, index, x + 1, z);
    this.selected = { what: "key", index, key: (plan.things[index]?.track.length ?? 1) - 1 };
    this.put(plan);
  }

  /** A coordinate on the grid. */
  snapped(metres: number): number {
    return edits.tidy(this.snap > 0 ? Math.round(metres / this.snap) * this.snap : metres);
  }

  /** What is selected may be gone. */
  private keepSelection(): void {
    const { selected, thing } = this;
    if (selected?.what === "stop" && !this.plan.tour[selected.index]) this.selected = null;
    else if (this.index !== null && !thing) this.selected = null;
    else if (selected?.what === "key" && !thing?.track[selected.key]) this.selected = { what: "thing", index: selected.index };
    this.changed();
  }
}
