import { describe, expect, it } from "vitest";
import { blockedSentence } from "../src/ui/blocked_sentence";

const AT = { ahead: 0.8, place: [0, 2] as [number, number] };

describe("blockedSentence", () => {
  it("names the obstacles and the place", () => {
    expect(blockedSentence({ reason: "noPosture", obstacles: ["beam 2", "crate 3"], ...AT })).toBe(
      "No way on: beam 2 and crate 3 leave no posture at 0.8 m ahead",
    );
    expect(blockedSentence({ reason: "outOfReach", obstacles: ["beam 2"], ...AT })).toBe(
      "No way on: beam 2 leaves no posture in reach at 0.8 m ahead",
    );
  });

  it("says here where it is here, and stays short", () => {
    const obstacles = ["a", "b", "c", "d", "e"];
    expect(blockedSentence({ reason: "noPosture", obstacles, ahead: 0, place: [0, 0] })).toBe(
      "No way on: a, b and 3 more leave no posture here",
    );
  });

  it("names nothing where only the motion between postures touches", () => {
    expect(blockedSentence({ reason: "motion", obstacles: [], ...AT })).toBe(
      "No way on: every motion that was tried touches 0.8 m ahead",
    );
  });
});
