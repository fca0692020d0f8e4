import { describe, expect, it } from "vitest";
import { BestTimes, courseName, courseOf, LeastClearance, nextScene } from "../src/results";
import { factsOf } from "../src/ui/finish_card";

const frame = (z: number, clearance: number, epoch = 1) => ({ epoch, x: 0, z, clearance });

describe("the least clearance of a crossing", () => {
  it("counts from the start on, and begins anew after a jump", () => {
    const least = new LeastClearance();
    for (const [z, clearance] of [[0, 0.01], [1, 0.4], [2, 0.05], [3, 0.3]] as const) least.add(frame(z, clearance), [0, 0]);
    expect(least.value).toBe(0.05);
    least.add(frame(4, 0.01, 2), [0, 0]);
    least.add(frame(4.1, 0.2, 2), [0, 0]);
    expect(least.value).toBe(0.2);
  });
});

describe("best times", () => {
  const store = () => {
    const kept = new Map<string, string>();
    return { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, value: string) => void kept.set(key, value) };
  };

  it("are kept for each scene and planner", () => {
    const storage = store();
    const best = new BestTimes(storage);
    expect(best.note("a", "exact", 5)).toBeNull();
    expect(best.note("a", "exact", 6)).toBe(5);
    expect(new BestTimes(storage).note("a", "exact", 4)).toBe(5);
    expect(best.note("a", "exact", 4.5)).toBe(4);
    expect(best.note("a", "figure6", 9)).toBeNull();
  });

  it("forget what is oldest, and survive a store that is broken or shut", () => {
    const storage = store();
    const best = new BestTimes(storage);
    for (let seed = 0; seed < 400; seed++) best.note(courseName(1, seed), "exact", 3);
    expect(best.note(courseName(1, 399), "exact", 4)).toBe(3);
    expect(best.note(courseName(1, 0), "exact", 4)).toBeNull();
    storage.setItem("elbowroom.best", "{broken");
    expect(best.note("a", "exact", 4)).toBeNull();
    expect(new BestTimes(null).note("a", "exact", 4)).toBeNull();
  });
});

describe("where to go next", () => {
  it("is the next course of the level, or the next scene of the menu", () => {
    const offered = ["a", "b", "gauntlet:1:0"];
    expect([nextScene("a", offered), nextScene("b", offered), nextScene("mine", offered)]).toEqual(["b", "a", "a"]);
    expect(nextScene("gauntlet:3:17", offered)).toBe("gauntlet:3:18");
    expect(nextScene("gauntlet:3:4294967295", offered)).toBe("gauntlet:3:0");
    expect(courseOf("gauntlet:3:17")).toEqual({ level: 3, seed: 17 });
    expect(courseOf("a")).toBeNull();
  });
});

describe("the finish card", () => {
  const crossed = { type: "crossed", seconds: 4.84, stuckTimes: 1, count: 1 } as const;

  it("tells stuck, clearance and best", () => {
    expect(factsOf({ crossed, clearance: 0.018, assist: true, best: 5.2 }).map(([, value]) => value)).toEqual(["once", "1.8 cm", "4.8 s"]);
    expect(factsOf({ crossed, clearance: -0.1, assist: false, best: null }).map(([, value]) => value))
      .toEqual(["once", "passed through things", "does not count without assist"]);
  });
});
