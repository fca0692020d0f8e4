/** One line in the middle of the page while something takes a while or the line to the server is down. */

import type { Loading } from "../generated/messages";
import type { ConnectionState } from "../net/connection";
import { worded } from "../texts/worded";
import { text } from "../texts/texts";
import { byId } from "./dom";

const PATIENCE_MS = 180;
const WHAT: Readonly<Record<Loading["what"], string>> = {
  scene: "Preparing the scene", avatar: "Reading the avatar", planner: "Building the planner",
  clip: "Putting the motion on the avatar",
};

export class Veil {
  private readonly element = byId("veil", HTMLElement);
  private readonly line = this.element.firstElementChild as HTMLElement;
  private readonly reasons = new Map<string, string>();
  private timer = 0;

  /** @param why the reason of a lost line */
  connection(state: ConnectionState, why: string): void {
    if (state === "lost") {
      for (const what of Object.keys(WHAT)) this.reasons.delete(what);
      this.set("connection", text("veil.again", why));
    } else this.set("connection", state === "connecting" ? worded("Connecting") : null);
  }

  loading({ what, active }: Loading): void {
    this.set(what, active ? worded(WHAT[what]) : null);
  }

  /** A file on its way to the server, and which of how many it is; null when all are through. */
  upload(name: string | null, at = 1, all = 1): void {
    const said = () => all > 1 ? text("veil.sendingOf", name ?? "", at, all) : text("veil.sending", name ?? "");
    this.set("upload", name === null ? null : said());
  }

  /** The avatar's own file on its way to the page. */
  download(active: boolean): void {
    this.set("download", active ? worded("Loading the avatar") : null);
  }

  private set(reason: string, said: string | null): void {
    if (said === null) this.reasons.delete(reason);
    else this.reasons.set(reason, said);
    window.clearTimeout(this.timer);
    // What is over in a moment does not flash.
    this.timer = window.setTimeout(() => this.show(), this.element.hidden ? PATIENCE_MS : 0);
  }

  private show(): void {
    const [said] = this.reasons.values();
    this.element.hidden = said === undefined;
    if (said !== undefined) this.line.textContent = `${said} …`;
  }
}
