import { describe, expect, it } from "vitest";
import { ServerClock } from "../src/net/server_clock";

describe("ServerClock", () => {
  it("follows the server a little behind and never runs backwards", () => {
    const clock = new ServerClock();
    let shown = -Infinity;
    for (let i = 0; i < 600; i++) {
      const server = i / 60;
      const jitter = (i * 7919) % 13 / 1000;
      clock.arrived(server, 100 + server + jitter);
      const now = clock.now(100 + server + jitter);
      expect(now).toBeGreaterThanOrEqual(shown);
      shown = now;
    }
    const behind = 599 / 60 - shown;
    expect(behind).toBeGreaterThan(0);
    expect(behind).toBeLessThan(0.05);
  });

  it("jumps when the server's time jumps", () => {
    const clock = new ServerClock();
    clock.arrived(50, 100);
    clock.now(100);
    clock.reset();
    expect(clock.now(100.1)).toBeNaN();
    clock.arrived(0, 101);
    expect(clock.now(101)).toBeLessThan(0);
  });

  it("widens the delay for a rough line, within bounds", () => {
    const smooth = new ServerClock();
    const rough = new ServerClock();
    for (let i = 0; i < 240; i++) {
      smooth.arrived(i / 60, i / 60);
      rough.arrived(i / 60, i / 60 + (i % 10 === 0 ? 0.08 : 0));
    }
    smooth.now(4);
    rough.now(4);
    expect(rough.delay).toBeGreaterThan(smooth.delay);
    expect(rough.delay).toBeLessThanOrEqual(0.18);
  });
});
