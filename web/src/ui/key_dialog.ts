/** The dialog in which keys are given to deeds. */

import { VIEWS, viewNamed } from "../camera/views";
import { capOf, type KeyDeed, type KeyMap } from "../input/key_map";
import { text, type TextName } from "../texts/texts";
import { TABLE } from "../texts/table";
import { worded } from "../texts/worded";
import { make } from "./dom";

export class KeyDialog {
  private readonly dialog = make("dialog", { id: "keys", "aria-labelledby": "keys-title" });
  private readonly list = make("ul", { class: "key-list" });
  private readonly said = make("p", { class: "hint", role: "status" });
  /** Which deed waits for a key. */
  private waiting: KeyDeed | null = null;

  /** @param changed called whenever a key does something else */
  constructor(private readonly keys: KeyMap, private readonly changed: () => void) {
    const close = make("button", { class: "icon", type: "button", "aria-label": text("keys.close") }, "✕");
    const reset = make("button", { class: "plain", type: "button" }, text("keys.reset"));
    close.addEventListener("click", () => this.dialog.close());
    reset.addEventListener("click", () => this.restore());
    const header = make("header", {}, make("h2", { id: "keys-title" }, text("keys.title")), close);
    this.dialog.append(make("div", { class: "help-body" }, header, make("p", {}, text("keys.how")), this.said, this.list, reset));
    this.dialog.addEventListener("keydown", (event) => this.key(event), true);
    this.dialog.addEventListener("close", () => (this.waiting = null));
    document.body.append(this.dialog);
  }

  open(): void {
    this.said.textContent = "";
    this.draw();
    this.dialog.showModal();
  }

  private draw(): void {
    this.list.replaceChildren(...this.keys.deeds.map((deed) => this.row(deed)));
  }

  private row(deed: KeyDeed): HTMLElement {
    const cap = this.waiting === deed ? text("keys.press") : capOf(this.keys.codeOf(deed));
    const button = make("button", { type: "button", class: "plain", "data-deed": deed, "aria-pressed": String(this.waiting === deed) }, cap);
    button.setAttribute("aria-label", `${titleOf(deed)}: ${cap}`);
    button.addEventListener("click", () => this.ask(deed));
    return make("li", {}, make("span", {}, titleOf(deed)), button);
  }

  private ask(deed: KeyDeed): void {
    this.waiting = deed;
    this.draw();
    this.focus(deed);
  }

  private key(event: KeyboardEvent): void {
    const { waiting, keys } = this;
    if (!waiting || event.code === "Tab") return;
    event.preventDefault();
    event.stopPropagation();
    if (event.code !== "Escape" && !keys.give(waiting, event.code)) {
      this.said.textContent = text("keys.refused", capOf(event.code));
      return;
    }
    this.waiting = null;
    this.said.textContent = event.code === "Escape" ? "" : text("keys.given", titleOf(waiting), capOf(keys.codeOf(waiting)));
    this.draw();
    this.focus(waiting);
    this.changed();
  }

  private restore(): void {
    this.keys.reset();
    this.waiting = null;
    this.said.textContent = "";
    this.draw();
    this.changed();
  }

  private focus(deed: KeyDeed): void {
    this.list.querySelector<HTMLElement>(`[data-deed="${deed}"]`)?.focus();
  }
}

/** What a deed is called. */
export function titleOf(deed: KeyDeed): string {
  if (deed.startsWith("view:")) return `${text("keys.camera")}: ${worded(VIEWS[viewNamed(deed.slice("view:".length))].title)}`;
  const name = `deed.${deed}`;
  return name in TABLE ? text(name as TextName) : deed;
}
