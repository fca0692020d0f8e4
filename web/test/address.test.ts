import { describe, expect, it } from "vitest";
import { isPrivate, isStep, queryOf, withOwnAvatar } from "../src/address";
import type { Settings } from "../src/generated/messages";
import { oddities, readWishes } from "../src/preferences";

const settings = {
  scene: "gauntlet:3:17", avatar: "alice", planner: "exact", queueSize: 5, walkSpeed: 1.1000000001, style: "plain",
  assist: true,
} as Settings;
const place = { settings, camera: "side" as const, overlays: new Set(["path", "ghosts"] as const) };

describe("the address line", () => {
  it("says scene, avatar, camera, planner, speed and overlays, and leaves the rest alone", () => {
    expect(queryOf(place, "?theme=dark&scene=a")).toBe(
      "?theme=dark&scene=gauntlet:3:17&avatar=alice&camera=side&planner=exact&queue=5&speed=1.1&overlays=path,ghosts",
    );
    expect(queryOf({ ...place, overlays: new Set() }, "")).toContain("overlays=none");
    expect(queryOf({ ...place, settings: { ...settings, assist: false } }, "")).toContain("assist=0");
    expect(queryOf(place, "?assist=0")).not.toContain("assist");
    expect(queryOf({ ...place, settings: { ...settings, style: "old" } }, "")).toContain("style=old");
    expect(queryOf(place, "?style=old")).not.toContain("style");
  });

  it("is read as it was written", () => {
    const wishes = readWishes(new URLSearchParams(queryOf(place, "")));
    expect(wishes).toMatchObject({
      scene: "gauntlet:3:17", avatar: "alice", planner: "exact", queueSize: 5, walkSpeed: 1.1, assist: null, camera: "side",
    });
  });

  it("tells what it does not know, and asks the server for none of it", () => {
    const query = new URLSearchParams("scene=nope&camera=9&speed=abc&queue=&overlays=path,stars&lang=tlh&theme=dark");
    expect(oddities(query)).toEqual(["camera=9", "speed=abc", "queue=", "overlays=path,stars", "lang=tlh"]);
    expect(readWishes(query)).toMatchObject({ scene: "nope", camera: "behind", walkSpeed: null, queueSize: null });
    expect(oddities(new URLSearchParams(queryOf(place, "?theme=dark&lang=zh-TW&quality=low")))).toEqual([]);
    expect(oddities(new URLSearchParams("overlays=all"))).toEqual([]);
  });

  it("does not name an avatar that only this page has", () => {
    const own = { ...settings, avatar: "0123456789abcdef" };
    expect(isPrivate(own.avatar)).toBe(true);
    expect(queryOf({ ...place, settings: own }, "?avatar=alice")).not.toContain("avatar");
  });

  it("names the page's own avatar only where it is handed on", () => {
    const own = withOwnAvatar("http://here/?scene=gauntlet:3:17&overlays=path,ghosts", "0123456789abcdef");
    expect(own).toBe("http://here/?scene=gauntlet:3:17&overlays=path,ghosts&avatar=0123456789abcdef");
    expect(withOwnAvatar("http://here/?avatar=alice", "alice")).toBe("http://here/?avatar=alice");
  });

  it("goes a step further when scene, avatar or planner change, not with camera or speed", () => {
    expect(isStep("?scene=a&planner=exact", "?scene=b&planner=exact")).toBe(true);
    expect(isStep("?scene=a&planner=exact", "?scene=a&planner=figure6")).toBe(true);
    expect(isStep("?scene=a&camera=side", "?scene=a&camera=front&speed=0.5")).toBe(false);
    expect(isStep("", "?scene=a")).toBe(false);
  });
});
