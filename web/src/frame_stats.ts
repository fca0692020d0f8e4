/** How long the page's frames take: median and 95th percentile over the last two seconds or so. */

const WINDOW = 120;

export class FrameStats {
  private readonly times: number[] = [];
  private next = 0;

  /** Notes the time between two frames, seconds. */
  add(seconds: number): void {
    this.times[this.next] = seconds;
    this.next = (this.next + 1) % WINDOW;
  }

  get fps(): number {
    const total = this.times.reduce((sum, t) => sum + t, 0);
    return total > 0 ? this.times.length / total : 0;
  }

  /** The time in milliseconds that a share of the frames does not exceed. */
  percentileMs(share: number): number {
    if (this.times.length === 0) return 0;
    const sorted = [...this.times].sort((a, b) => a - b);
    return 1000 * (sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? 0);
  }
}
