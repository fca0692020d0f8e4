import { describe, expect, it } from "vitest";
import { HELD_DEEDS, KeyMap } from "../src/input/key_map";
import { titleOf } from "../src/ui/key_dialog";

function storage(kept = ""): Storage {
  let value = kept;
  return { getItem: () => value || null, setItem: (_: string, now: string) => void (value = now) } as unknown as Storage;
}

describe("the keys", () => {
  it("do what they do until they are given to something else", () => {
    const keys = new KeyMap(null);
    expect(keys.deedOf("KeyW")).toBe("forward");
    expect(keys.deedOf("ArrowUp")).toBe("forward");
    expect(keys.deedOf("KeyZ")).toBeUndefined();
    expect(keys.give("forward", "KeyZ")).toBe(true);
    expect(keys.deedOf("KeyZ")).toBe("forward");
    expect(keys.deedOf("KeyW")).toBeUndefined();
    expect(keys.capNow("W")).toBe("Z");
    expect(keys.capNow("left stick")).toBe("left stick");
  });

  it("change places where both are taken, so that nothing is out of reach", () => {
    const keys = new KeyMap(null);
    keys.give("forward", "KeyS");
    expect(keys.deedOf("KeyS")).toBe("forward");
    expect(keys.deedOf("KeyW")).toBe("back");
    expect(new Set(keys.deeds.map((deed) => keys.codeOf(deed))).size).toBe(keys.deeds.length);
  });

  it("leave alone what pages and browsers need", () => {
    const keys = new KeyMap(null);
    for (const code of ["Tab", "Enter", "Escape", "F5", "ControlLeft", "ArrowUp", "Space", ""]) expect(keys.give("run", code)).toBe(false);
    expect(keys.codeOf("run")).toBe("ShiftLeft");
  });

  it("are kept, and come back as they came", () => {
    const store = storage();
    new KeyMap(store).give("pause", "KeyG");
    const keys = new KeyMap(store);
    expect(keys.deedOf("KeyG")).toBe("pause");
    keys.reset();
    expect(new KeyMap(store).deedOf("KeyP")).toBe("pause");
  });

  it("mind nothing that was stored wrongly", () => {
    for (const wrong of ["{", "3", "null", '{"pause": 3}', '{"pause": "Tab"}', '{"nothing": "KeyG"}', '{"pause": "KeyW"}']) {
      const keys = new KeyMap(storage(wrong));
      expect(keys.deedOf("KeyP")).toBe("pause");
      expect(keys.deedOf("KeyW")).toBe("forward");
    }
  });

  it("all have a name", () => {
    for (const deed of [...new KeyMap(null).deeds, ...HELD_DEEDS]) expect(titleOf(deed)).not.toBe(deed);
  });
});
