/** Sentences for the user: they appear under the bar and go by themselves or at a click. */

import { worded } from "../texts/worded";
import { byId, make } from "./dom";

const SECONDS: Readonly<Record<Level, number>> = { info: 5, warning: 9, error: 14 };
const MOST = 3;

type Level = "info" | "warning" | "error";

export class Notices {
  private readonly host = byId("notices", HTMLElement);

  show(level: Level, message: string): void {
    const close = make("button", { type: "button", "aria-label": worded("Dismiss") }, "✕");
    const notice = make("div", { class: `notice ${level}` }, make("p", {}, message), close);
    close.addEventListener("click", () => notice.remove());
    for (const other of [...this.host.children]) if (other.firstChild?.textContent === message) other.remove();
    this.host.append(notice);
    while (this.host.children.length > MOST) this.host.firstElementChild?.remove();
    window.setTimeout(() => notice.remove(), SECONDS[level] * 1000);
  }
}
