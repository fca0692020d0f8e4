/** Two fingers on the board: what lies under them goes with them. */

import type { Vec2 } from "./plan";

/** What fingers have done: the point between them went from one place to another, CSS pixels, and they came apart by a factor. */
export interface Pinched {
  readonly from: Vec2;
  readonly to: Vec2;
  readonly apart: number;
}

export class Pinch {
  private readonly fingers = new Map<number, Vec2>();

  /** Whether two fingers are down. */
  get on(): boolean {
    return this.fingers.size >= 2;
  }

  down(finger: number, at: Vec2): void {
    this.fingers.set(finger, at);
  }

  up(finger: number): void {
    this.fingers.delete(finger);
  }

  /** A finger has moved; null where that is no pinch. */
  move(finger: number, at: Vec2): Pinched | null {
    const before = this.seen();
    if (!this.fingers.has(finger)) return null;
    this.fingers.set(finger, at);
    const after = this.seen();
    if (!before || !after) return null;
    const apart = before.spread > 0 && after.spread > 0 ? after.spread / before.spread : 1;
    return { from: before.middle, to: after.middle, apart };
  }

  private seen(): { readonly middle: Vec2; readonly spread: number } | null {
    const [a, b] = [...this.fingers.values()];
    if (!a || !b) return null;
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], spread: Math.hypot(a[0] - b[0], a[1] - b[1]) };
  }
}
