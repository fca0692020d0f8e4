/** By keys: one thing after the other is taken in hand, the arrow keys push it as the camera looks, Escape lets go. */

import type { Hand } from "./hand";

/** m/s, somewhat slower than the server lets things go. */
const SPEED = 1.2;
const DIRECTIONS: Readonly<Record<string, readonly [right: number, ahead: number]>> = {
  ArrowUp: [0, 1], ArrowDown: [0, -1], ArrowLeft: [-1, 0], ArrowRight: [1, 0],
};

/** Something that can be taken in hand. */
export interface Graspable {
  readonly number: number;
  readonly place: readonly [x: number, z: number];
}

export interface ArrowsHost {
  /** Where the camera looks, radians. */
  heading(): number;
  /** What can be pushed, the nearest first. */
  offered(): readonly Graspable[];
  /** Another thing is in hand, or none. */
  chosen(number: number | null): void;
}

export class ArrowPushing {
  private chosen: number | null = null;
  private readonly tried = new Set<number>();
  private readonly held = new Set<string>();

  constructor(private readonly host: ArrowsHost, private readonly hand: Hand) {
    window.addEventListener("keydown", (event) => this.down(event), { capture: true });
    window.addEventListener("keyup", ({ code }) => this.held.delete(code), { capture: true });
    window.addEventListener("blur", () => this.held.clear());
  }

  /** Whether a thing is in hand. */
  get holds(): boolean {
    return this.chosen !== null;
  }

  /** Takes the next thing in hand; after the last one, none. */
  next(): void {
    const offered = this.host.offered();
    const next = offered.find(({ number }) => !this.tried.has(number));
    this.release();
    if (!next) {
      this.tried.clear();
      return;
    }
    this.tried.add(next.number);
    this.chosen = next.number;
    this.hand.take(next.number, next.place);
    this.host.chosen(next.number);
  }

  release(): void {
    this.held.clear();
    if (this.chosen === null) return;
    if (this.hand.number === this.chosen) this.hand.letGo();
    this.chosen = null;
    this.host.chosen(null);
  }

  /** Pushes by what is held down. Once a frame. */
  update(dt: number): void {
    if (this.chosen === null || this.held.size === 0 || this.hand.number !== this.chosen) return;
    let [right, ahead] = [0, 0];
    for (const code of this.held) {
      right += DIRECTIONS[code]?.[0] ?? 0;
      ahead += DIRECTIONS[code]?.[1] ?? 0;
    }
    const heading = this.host.heading(), way = SPEED * dt;
    const [sine, cosine] = [Math.sin(heading), Math.cos(heading)];
    const [x, z] = this.hand.goal;
    this.hand.move(x + way * (ahead * sine - right * cosine), z + way * (ahead * cosine + right * sine));
  }

  private down(event: KeyboardEvent): void {
    if (this.chosen === null || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.code === "Escape") this.release();
    else if (event.code in DIRECTIONS) this.held.add(event.code);
    else return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }
}
