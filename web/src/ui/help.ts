/** The help dialog. */

import { byId, make } from "./dom";

type Row = readonly [keys: readonly string[], meaning: string];

const SECTIONS: readonly (readonly [title: string, rows: readonly Row[]])[] = [
  ["Walk", [
    [["W", "A", "S", "D"], "or the arrow keys: walk where the camera looks"],
    [["S"], "back up, facing the same way"],
    [["Q", "E"], "step to the left and right"],
    [["Shift"], "run"],
    [["R"], "back to the start"],
  ]],
  ["Look", [
    [["drag"], "look around; the wheel or a pinch zooms"],
    [["C"], "bring the camera behind the avatar"],
    [["L"], "lock the pointer to the view, Esc frees it"],
    [["V"], "steer relative to the camera or to the body"],
  ]],
  ["Time", [
    [["P"], "or Space: pause"],
    [["."], "one step of 1/60 s"],
    [["M"], "slow motion"],
  ]],
  ["See", [
    [["T"], "assist on and off: planned motion or the canned walk"],
    [["O"], "overlays"],
    [["N"], "menu"],
    [["H"], "hide everything but the world"],
    [["?"], "or F1: this help"],
  ]],
  ["Gamepad", [
    [["left stick"], "walk"],
    [["right stick"], "look; press it to recentre"],
    [["A", "RT"], "run"],
    [["LB", "RB"], "step aside"],
    [["X", "Y"], "assist, steering"],
  ]],
  ["Touch", [
    [["left half"], "the stick; push far out to run"],
    [["right half"], "drag to look, two fingers zoom"],
  ]],
];

export class Help {
  private readonly dialog = byId("help", HTMLDialogElement);

  constructor() {
    const close = make("button", { class: "icon", type: "button", "aria-label": "Close help" }, "✕");
    close.addEventListener("click", () => this.close());
    this.dialog.addEventListener("click", (event) => {
      if (event.target === this.dialog) this.close();
    });
    const intro =
      "You steer; the avatar finds its own way to fit. It bends, twists and moves its arms so that no part of it " +
      "touches anything. Walk it through the gate. Switch Assist off to see the same walk without planning.";
    const columns = make("div", { class: "help-columns" }, ...SECTIONS.map(([title, rows]) => section(title, rows)));
    const header = make("header", {}, make("h2", { id: "help-title" }, "How to steer"), close);
    this.dialog.append(make("div", { class: "help-body" }, header, make("p", {}, intro), columns));
  }

  get isOpen(): boolean {
    return this.dialog.open;
  }

  toggle(): void {
    if (this.dialog.open) this.close();
    else this.dialog.showModal();
  }

  close(): void {
    this.dialog.close();
  }
}

function section(title: string, rows: readonly Row[]): HTMLElement {
  const list = make("dl", { class: "keys" });
  for (const [keys, meaning] of rows) {
    const caps = keys.flatMap((key, i) => (i === 0 ? [make("kbd", {}, key)] : [" ", make("kbd", {}, key)]));
    list.append(make("dt", {}, ...caps), make("dd", {}, meaning));
  }
  return make("section", {}, make("h3", {}, title), list);
}
