/** What is in hand: where to it is to be pushed, told to the server often enough and not too often. */

import type { ClientMessage } from "../generated/messages";

/** Seconds between two messages about one thing. */
const OFTEN = 1 / 30;

export class Hand {
  /** The number of the obstacle that is in hand. */
  number: number | null = null;
  private place: readonly [x: number, z: number] = [0, 0];
  private told = -Infinity;
  private news = false;

  constructor(private readonly send: (message: ClientMessage) => void) {}

  take(number: number, place: readonly [number, number]): void {
    if (this.number !== null && this.number !== number) this.letGo();
    this.number = number;
    this.place = place;
  }

  /** Where the middle of what is in hand is to be. */
  get goal(): readonly [x: number, z: number] {
    return this.place;
  }

  move(x: number, z: number): void {
    this.place = [x, z];
    this.news = true;
  }

  /** Says what is new. Once a frame, `now` in seconds. */
  update(now: number): void {
    if (this.number === null || !this.news || now - this.told < OFTEN) return;
    this.news = false;
    this.told = now;
    this.send({ type: "push", obstacle: this.number, place: [this.place[0], this.place[1]] });
  }

  letGo(): void {
    if (this.number === null) return;
    this.update(Infinity);
    this.send({ type: "push", obstacle: this.number, place: null });
    this.number = null;
    this.news = false;
    this.told = -Infinity;
  }
}
