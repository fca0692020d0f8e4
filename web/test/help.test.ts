import { describe, expect, it } from "vitest";
import { PAD_BUTTONS } from "../src/input/gamepad";
import { DEFAULT_KEYS } from "../src/input/key_map";
import { helpSections } from "../src/ui/help_sections";

const sections = helpSections({ touch: false, gamepad: false });
const words = sections.filter(({ title }) => !["Gamepad", "Touch"].includes(title))
  .flatMap(({ rows }) => rows.flatMap(([keys, meaning]) => [...keys, ...meaning.split(/\W+/)]));

describe("the help", () => {
  it("names every button of a gamepad that does something", () => {
    const named = sections.find(({ title }) => title === "Gamepad")?.rows.flatMap(([keys]) => keys);
    expect(named).toEqual(expect.arrayContaining(PAD_BUTTONS.map(({ name }) => name)));
  });

  it("names every key that does something", () => {
    const names: Readonly<Record<string, string>> = { Period: ".", Comma: ",", Equal: "=", Minus: "-", Escape: "Esc", ShiftLeft: "Shift", ShiftRight: "Shift" };
    for (const code of DEFAULT_KEYS.keys()) {
      if (code.startsWith("Arrow")) expect(words).toContain("arrow");
      else expect(words).toContain(names[code] ?? code.replace(/^(Key|Digit)/, ""));
    }
  });

  it("begins with the device at hand", () => {
    expect(sections[0]?.title).toBe("Walk");
    expect(helpSections({ touch: true, gamepad: false })[0]?.title).toBe("Touch");
    expect(helpSections({ touch: false, gamepad: true })[0]?.title).toBe("Gamepad");
    for (const touch of [false, true]) {
      for (const gamepad of [false, true]) expect(new Set(helpSections({ touch, gamepad })).size).toBe(sections.length);
    }
  });
});
