/**
 * Where on the server's time line the picture should be now.
 *
 * A frame that carries server time `t` arrives at local time `a`. The smallest `a - t` seen lately is the offset of a
 * frame that nothing delayed; how far the others lie above it is the jitter. The picture runs behind the newest
 * undelayed frame by a small delay that covers most of the jitter, and never runs backwards.
 */

const WINDOW = 120;
const MIN_DELAY = 0.012;
const MAX_DELAY = 0.18;
const SNAP = 0.5;

export class ServerClock {
  private readonly offsets: number[] = [];
  private next = 0;
  private shown = NaN;
  private lastLocal = NaN;
  private currentDelay = 0.035;

  /** @param interval the time between two frames of the server, seconds */
  constructor(private readonly interval: number = 1 / 60) {}

  /** Seconds that the picture stays behind. */
  get delay(): number {
    return this.currentDelay;
  }

  /** Forgets everything: after a reconnect, or when the server's time starts anew. */
  reset(): void {
    this.offsets.length = 0;
    this.next = 0;
    this.shown = NaN;
    this.lastLocal = NaN;
  }

  /** Notes a frame: `serverTime` in the message, `localTime` of its arrival, both in seconds. */
  arrived(serverTime: number, localTime: number): void {
    this.offsets[this.next] = localTime - serverTime;
    this.next = (this.next + 1) % WINDOW;
  }

  /** The server time to show at `localTime`; NaN before the first frame. */
  now(localTime: number): number {
    if (this.offsets.length === 0) return NaN;
    const sorted = [...this.offsets].sort((a, b) => a - b);
    const earliest = sorted[0] ?? 0;
    const late = (sorted[Math.floor(sorted.length * 0.95)] ?? earliest) - earliest;
    const wanted = Math.min(Math.max(late + this.interval, MIN_DELAY), MAX_DELAY);
    const target = localTime - earliest - wanted;
    this.currentDelay = wanted;
    const elapsed = Number.isNaN(this.lastLocal) ? 0 : Math.max(0, localTime - this.lastLocal);
    this.lastLocal = localTime;
    if (Number.isNaN(this.shown) || Math.abs(target - this.shown - elapsed) > SNAP) {
      this.shown = target;
    } else {
      const ahead = this.shown + elapsed;
      const correction = (target - ahead) * Math.min(1, elapsed * 4);
      this.shown = Math.max(this.shown, ahead + correction);
    }
    return this.shown;
  }
}
