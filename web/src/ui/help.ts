/** The help dialog. */

import { connectedPad } from "../input/gamepad";
import type { KeyMap } from "../input/key_map";
import { worded } from "../texts/worded";
import { byId, make } from "./dom";
import { helpSections, type Section } from "./help_sections";

export const INTRO =
  "You steer; the avatar finds its own way to fit. It bends, twists and moves its arms so that no part of it " +
  "touches anything. Walk it through the gate. Switch Assist off to see the same walk without planning.";

export class Help {
  private readonly dialog = byId("help", HTMLDialogElement);
  private readonly columns = make("div", { class: "help-columns" });
  private readonly touch = window.matchMedia("(pointer: coarse)");

  constructor(private readonly keyMap: KeyMap) {
    const close = make("button", { class: "icon", type: "button", "aria-label": worded("Close help") }, "✕");
    close.addEventListener("click", () => this.close());
    this.dialog.addEventListener("click", (event) => {
      if (event.target === this.dialog) this.close();
    });
    const header = make("header", {}, make("h2", { id: "help-title" }, worded("How to steer")), close);
    this.dialog.append(make("div", { class: "help-body" }, header, make("p", {}, worded(INTRO)), this.columns));
  }

  get isOpen(): boolean {
    return this.dialog.open;
  }

  /** Opens it, with the device at hand first, or closes it. */
  toggle(): void {
    if (this.dialog.open) {
      this.close();
      return;
    }
    const sections = helpSections({ touch: this.touch.matches, gamepad: connectedPad() !== null });
    this.columns.replaceChildren(...sections.map((section) => drawn(section, (cap) => this.keyMap.capNow(cap))));
    this.dialog.showModal();
    this.dialog.scrollTop = 0;
  }

  close(): void {
    this.dialog.close();
  }
}

function drawn({ title, rows }: Section, capNow: (cap: string) => string): HTMLElement {
  const list = make("dl", { class: "keys" });
  for (const [keys, meaning] of rows) {
    const kbd = (key: string) => make("kbd", {}, worded(title === "Gamepad" ? key : capNow(key)));
    const caps = keys.flatMap((key, i) => (i === 0 ? [kbd(key)] : [" ", kbd(key)]));
    list.append(make("dt", {}, ...caps), make("dd", {}, worded(meaning)));
  }
  return make("section", {}, make("h3", {}, worded(title)), list);
}
