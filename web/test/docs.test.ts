import { describe, expect, it } from "vitest";
import text from "../../docs/page.md?raw";
import { VIEW_NAMES } from "../src/camera/views";
import { PAD_BUTTONS } from "../src/input/gamepad";
import { DEFAULT_KEYS } from "../src/input/key_map";
import { OVERLAYS } from "../src/overlays/overlay_names";

describe("docs/page.md", () => {
  it("names every key and every button that does something", () => {
    const names: Readonly<Record<string, string>> = { Period: ".", Comma: ",", Equal: "=", Minus: "-", Escape: "Esc", ShiftLeft: "Shift", ShiftRight: "Shift" };
    for (const code of DEFAULT_KEYS.keys()) {
      expect(text).toContain(code.startsWith("Arrow") ? "arrows" : `\`${names[code] ?? code.replace(/^(Key|Digit)/, "")}\``);
    }
    for (const { name } of PAD_BUTTONS) expect(text).toContain(`\`${name}\``);
  });

  it("names every camera and every overlay as the address does", () => {
    for (const name of VIEW_NAMES) expect(text).toContain(`\`${name}\``);
    expect(text).toContain(`\`${OVERLAYS.join()}\``);
  });
});
