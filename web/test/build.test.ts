import { describe, expect, it } from "vitest";
import { shownColour } from "../src/builder/colours";
import { documentOf, nameOf, planOf } from "../src/builder/document";
import { Drafts } from "../src/builder/drafts";
import { Editor } from "../src/builder/editor";
import { atPace, copied, extended, moved, paceOf, placed, removed, scaledBy, stopped, turnedBy, yawOf } from "../src/builder/edits";
import { History } from "../src/builder/history";
import { linkOf, sceneIn } from "../src/builder/link";
import { convexHull, inWorld, onBoard, outline } from "../src/builder/outline";
import { Pinch } from "../src/builder/pinch";
import { emptyPlan, UPRIGHT, type Plan } from "../src/builder/plan";
import { previewOf } from "../src/builder/preview";
import { fresh, halfSize, KINDS } from "../src/builder/shapes";
import { PALETTES } from "../src/stage/palette";
import { anglesOf, turned, turnOf } from "../src/builder/turns";

const KIND = (kind: string) => kind;

/** One of each kind, the last of them on a track. */
function busyPlan(): Plan {
  let plan = emptyPlan("A test");
  KINDS.forEach((kind, i) => (plan = placed(plan, kind, i, 2, kind) ?? plan));
  plan = turnedBy(plan, { what: "thing", index: 0 }, 0.3);
  return extended(extended(plan, 1, 3, 4), 1, 3, 5);
}

describe("colours", () => {
  it("are on the board as in the picture, where what moves comes last", () => {
    const plan = busyPlan();
    const { obstacles, moving } = previewOf(plan);
    const drawn = [...obstacles, ...moving].map(({ name }) => name);
    const { obstacles: colours } = PALETTES.dark;
    plan.things.forEach(({ name }, i) => {
      const colour = colours[drawn.indexOf(name) % colours.length] ?? 0;
      expect(shownColour(plan, i, "dark")).toBe(`#${colour.toString(16).padStart(6, "0")}`);
    });
    expect(new Set(plan.things.map((_, i) => shownColour(plan, i, "light"))).size).toBeGreaterThan(3);
    expect(shownColour({ ...plan, things: plan.things.map((thing) => ({ ...thing, color: "#123456" })) }, 2, "light")).toBe("#123456");
  });
});

describe("a plan and its document", () => {
  it("say the same, whatever stands in it", () => {
    const plan = busyPlan();
    const back = planOf(JSON.parse(JSON.stringify(documentOf(plan))) as ReturnType<typeof documentOf>);
    const byName = ({ things }: Plan) => Object.fromEntries(things.map((thing) => [thing.name, thing]));
    expect(byName(back)).toEqual(byName(plan));
    expect({ ...back, things: [] }).toEqual({ ...plan, things: [] });
    expect(documentOf(plan).moving).toHaveLength(1);
  });

  it("keeps the floors of stops, and which of them are left open", () => {
    const open = stopped(stopped(emptyPlan("Floors"), 1, 2) ?? emptyPlan(""), 3, 4) ?? emptyPlan("");
    const plan = moved(open, { what: "stop", index: 1 }, [0, 2.5, 0]);
    expect(documentOf(plan).tour?.map(({ position }) => position)).toEqual([[1, 2], [3, 2.5, 4]]);
    expect(planOf(documentOf(plan)).tour).toEqual(plan.tour);
  });

  it("has a name that a file can have", () => {
    expect(nameOf("  My attic / 2 ")).toBe("My-attic-2");
    expect(nameOf("我的場景")).toBe("我的場景");
    expect(nameOf("///")).toBe("scene");
  });

  it("is drawn with every shape as large as it is", () => {
    const { obstacles, moving } = previewOf(busyPlan());
    expect(obstacles).toHaveLength(KINDS.length - 1);
    expect(moving[0]?.times.length).toBe(3);
    const hull = obstacles.find(({ form }) => form.shape === "hull");
    expect(hull?.form.triangles.length).toBeGreaterThan(4);
  });
});

describe("edits", () => {
  it("leave the plan that they began with as it was", () => {
    const plan = busyPlan();
    const before = JSON.stringify(plan);
    const thing = { what: "thing", index: 0 } as const;
    moved(plan, thing, [1, 2, 3]);
    scaledBy(plan, thing, 2);
    removed(plan, thing);
    copied(plan, 0, 1);
    expect(JSON.stringify(plan)).toBe(before);
  });

  it("keep what stands on the ground there when it grows", () => {
    for (const [index] of KINDS.entries()) {
      const thing = scaledBy(busyPlan(), { what: "thing", index }, 1.7).things[index];
      if (thing && thing.track.length === 0) expect(thing.center[1]).toBeCloseTo(halfSize(thing.shape)[1], 3);
    }
  });

  it("turn about the upright, so far as is said", () => {
    const plan = turnedBy(busyPlan(), { what: "thing", index: 0 }, 0.5);
    expect(plan.things[0] && yawOf(plan.things[0])).toBeCloseTo(0.8, 6);
  });

  it("make a track of clicks, gone along at an even speed, and a thing that stands of its last point", () => {
    const plan = busyPlan();
    const thing = plan.things[1];
    expect(thing?.track).toHaveLength(3);
    expect(thing && paceOf(thing)).toBeCloseTo(0.8, 2);
    const fast = atPace(plan, 1, 2).things[1];
    expect(fast && paceOf(fast)).toBeCloseTo(2, 2);
    const one = removed(removed(plan, { what: "key", index: 1, key: 2 }), { what: "key", index: 1, key: 0 }).things[1];
    expect(one?.track).toEqual([]);
    expect(one?.center).toEqual(thing?.track[1]?.center);
  });

  it("end where there are too many things", () => {
    let plan: Plan | null = emptyPlan("full");
    for (let i = 0; i < 500; i++) plan = plan && placed(plan, "box", 0, 0, "box");
    expect(plan?.things).toHaveLength(500);
    expect(plan && placed(plan, "box", 0, 0, "box")).toBeNull();
    expect(plan && copied(plan, 0, 1)).toBeNull();
  });
});

describe("the editor", () => {
  it("takes back and does again, a drag at a time", () => {
    const editor = new Editor(emptyPlan("t"), KIND, () => undefined);
    editor.place("box", 1, 1);
    const placedAt = editor.thing?.center;
    for (const step of [1, 2, 3]) {
      const { selected } = editor;
      if (selected) editor.put(moved(editor.plan, selected, [0.1 * step, 0, 0]), "drag 1");
    }
    editor.undo();
    expect(editor.thing?.center).toEqual(placedAt);
    editor.redo();
    expect(editor.thing?.center[0]).toBeCloseTo(1.6, 6);
    editor.undo();
    editor.undo();
    expect(editor.plan.things).toEqual([]);
    expect(editor.selected).toBeNull();
    expect(editor.canUndo).toBe(false);
  });

  it("keeps the keyboard on the grid", () => {
    const editor = new Editor(emptyPlan("t"), KIND, () => undefined);
    editor.snapTo(0.25);
    expect(editor.snapped(0.6)).toBe(0.5);
    editor.place("sphere", 0.5, 1);
    editor.nudge([1, 0, 0], false);
    editor.nudge([0, 0, -1], true);
    expect(editor.thing?.center[0]).toBe(0.75);
    expect(editor.thing?.center[2]).toBe(-1.5);
  });

  it("makes a track without a pointer", () => {
    const editor = new Editor(emptyPlan("t"), KIND, () => undefined);
    editor.place("box", 0, 3);
    editor.extend();
    expect(editor.selected).toEqual({ what: "key", index: 0, key: 1 });
    editor.nudge([1, 0, 0], true);
    expect(editor.thing?.track.map(({ center }) => center[0])).toEqual([0, 2]);
  });
});

describe("history", () => {
  it("forgets what is long ago, and what was undone once something else is done", () => {
    const history = new History(0);
    for (let i = 1; i <= 300; i++) history.put(i);
    for (let i = 0; i < 300; i++) history.undo();
    expect(history.present).toBe(100);
    history.put(7);
    expect(history.canRedo).toBe(false);
  });
});

describe("the board", () => {
  it("has the avatar walk up the picture, its left at the left", () => {
    expect(onBoard("top", [1, 0, 2])).toEqual([-1, -2]);
    for (const side of ["top", "side"] as const) {
      const by = inWorld(side, [0.3, -0.7]);
      expect(onBoard(side, by)[0]).toBeCloseTo(0.3, 9);
      expect(onBoard(side, by)[1]).toBeCloseTo(-0.7, 9);
    }
  });

  it("outlines every kind: all of its corners lie within", () => {
    for (const [i, kind] of KINDS.entries()) {
      const shape = fresh(kind);
      const thing = { name: "", color: "", shape, center: [i, 1, 0] as const, rotation: UPRIGHT, track: [], repeat: "loop" as const };
      const flat = outline("top", thing, thing.center, UPRIGHT);
      const [x, , z] = halfSize(shape);
      expect(Math.max(...flat.map(([u]) => u))).toBeCloseTo(-i + x, 2);
      expect(Math.max(...flat.map(([, v]) => v))).toBeCloseTo(z, 2);
    }
  });

  it("draws hulls that turn one way only", () => {
    const hull = convexHull([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5], [0.5, 0]]);
    expect(hull).toHaveLength(4);
  });
});

describe("turns", () => {
  it("go to angles and back", () => {
    for (const angles of [[0.3, -1.2, 0.7], [0, 2, 0], [-0.4, 0, 0]] as const) {
      anglesOf(turnOf(angles)).forEach((angle, i) => expect(angle).toBeCloseTo(angles[i] ?? 0, 9));
    }
    turned([0, 0, 1], turnOf([0, Math.PI / 2, 0])).forEach((value, i) => expect(value).toBeCloseTo([1, 0, 0][i] ?? 0, 9));
  });
});

describe("a link", () => {
  it("holds a small scene, and only that", async () => {
    const scene = JSON.stringify(documentOf(busyPlan()));
    const link = await linkOf(scene, "http://127.0.0.1:8765/?scene=a#old");
    expect(link?.length).toBeLessThan(2000);
    expect(await sceneIn(new URL(link ?? "").hash)).toBe(scene);
    const noise = Array.from({ length: 20_000 }, (_, i) => String.fromCharCode(33 + ((i * i * 7919) % 90))).join("");
    const random = Array.from(crypto.getRandomValues(new Uint8Array(20_000)), (byte) => byte.toString(36)).join("");
    expect(await linkOf(noise + random, "http://127.0.0.1/")).toBeNull();
  });

  it("is refused where it is broken or unpacks to too much", async () => {
    for (const hash of ["#scene=", "#scene=%%%", "#scene=AAAA", "#scene=zzzz"]) expect(await sceneIn(hash) || null).toBeNull();
    const bomb = await linkOf("0".repeat(2_000_000), "http://127.0.0.1/");
    expect(bomb).not.toBeNull();
    expect(await sceneIn(new URL(bomb ?? "").hash)).toBeNull();
  });
});

describe("drafts", () => {
  const storage = () => {
    const kept = new Map<string, string>();
    return { getItem: (name: string) => kept.get(name) ?? null, setItem: (name: string, value: string) => void kept.set(name, value) } as unknown as Storage;
  };

  it("are kept by title, the newest first, and not for ever", () => {
    const drafts = new Drafts(storage());
    for (let i = 0; i < 30; i++) drafts.keep(emptyPlan(`plan ${i}`));
    drafts.keep({ ...emptyPlan("plan 20"), description: "again" });
    expect(drafts.all()[0]?.description).toBe("again");
    expect(drafts.all()).toHaveLength(20);
    drafts.drop("plan 20");
    expect(drafts.all().map(({ title }) => title)).not.toContain("plan 20");
  });

  it("mind neither a store that is missing nor one that holds something else", () => {
    new Drafts(null).keep(emptyPlan("a"));
    expect(new Drafts(null).all()).toEqual([]);
    for (const broken of ["{", "3", '[{"title": 1}]']) {
      const store = storage();
      store.setItem("elbowroom.drafts", broken);
      expect(new Drafts(store).all()).toEqual([]);
    }
  });
});

describe("two fingers", () => {
  it("pull what is between them, and one does not", () => {
    const pinch = new Pinch();
    pinch.down(1, [100, 100]);
    expect(pinch.move(1, [110, 100])).toBeNull();
    pinch.down(2, [210, 100]);
    expect(pinch.move(2, [310, 140])).toEqual({ from: [160, 100], to: [210, 120], apart: Math.hypot(200, 40) / 100 });
    pinch.up(1);
    expect(pinch.on).toBe(false);
    expect(pinch.move(2, [0, 0])).toBeNull();
    expect(pinch.move(3, [0, 0])).toBeNull();
  });
});
