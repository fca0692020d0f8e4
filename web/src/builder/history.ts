/** What was before, to go back to and forth again. */

const MOST = 200;

export class History<T> {
  private past: T[] = [];
  private future: T[] = [];
  private tag: string | null = null;

  constructor(private now: T) {}

  get present(): T {
    return this.now;
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }

  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** Goes on to another state. Those with the same tag, one after the other, are one step: a drag. */
  put(next: T, tag: string | null = null): void {
    if (next === this.now) return;
    if (tag === null || tag !== this.tag) this.past.push(this.now);
    if (this.past.length > MOST) this.past.shift();
    this.future = [];
    this.now = next;
    this.tag = tag;
  }

  undo(): void {
    this.go(this.past, this.future);
  }

  redo(): void {
    this.go(this.future, this.past);
  }

  private go(from: T[], to: T[]): void {
    if (from.length === 0) return;
    to.push(this.now);
    this.now = from.pop() as T;
    this.tag = null;
  }
}
