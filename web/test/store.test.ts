import { describe, expect, it } from "vitest";
import { keptOf } from "../src/replay/store";

describe("the walks that are kept in the browser", () => {
  const walks = (...counts: number[]) => counts.map((count, i) => ({ count, i }));

  it("are the newest that fit", () => {
    expect(keptOf(walks(10, 20, 30, 40), 75).map(({ i }) => i)).toEqual([2, 3]);
    expect(keptOf(walks(10, 20), 100).map(({ i }) => i)).toEqual([0, 1]);
    expect(keptOf([], 10)).toEqual([]);
  });

  it("are one at least, however long", () => {
    expect(keptOf(walks(5, 500), 100).map(({ i }) => i)).toEqual([1]);
  });
});
