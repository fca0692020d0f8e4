/** What the address line says, so that a place can be sent to someone, kept, and gone back to. */

import type { ViewName } from "./camera/views";
import type { Settings } from "./generated/messages";
import { OVERLAYS, type OverlayName } from "./overlays/overlay_names";

/** What is shown: the session's choices and the page's own. */
export interface Place {
  readonly settings: Settings;
  readonly camera: ViewName;
  readonly overlays: ReadonlySet<OverlayName>;
}

/** The style of walking of who asks for none: the address does not speak of it. */
export const PLAIN = "plain";
/** A change of one of these is a step that the browser's back button undoes. */
const STEPS = ["scene", "avatar", "planner"] as const;
/** The server calls what was dropped on a page by a number like this; it is nobody else's. */
const DROPPED = /^[0-9a-f]{16}$/;

/** The query of the address line for a place; what it does not speak of stays as it was. */
export function queryOf({ settings, camera, overlays }: Place, before: string): string {
  const query = new URLSearchParams(before);
  const { scene, avatar, planner, queueSize, walkSpeed, style, assist } = settings;
  query.set("scene", scene);
  if (isPrivate(avatar)) query.delete("avatar");
  else query.set("avatar", avatar);
  query.set("camera", camera);
  query.set("planner", planner);
  query.set("queue", String(queueSize));
  query.set("speed", String(Number(walkSpeed.toFixed(2))));
  if (style === PLAIN) query.delete("style");
  else query.set("style", style);
  query.set("overlays", OVERLAYS.filter((name) => overlays.has(name)).join() || "none");
  if (assist) query.delete("assist");
  else query.set("assist", "0");
  return `?${query}`.replaceAll("%3A", ":").replaceAll("%2C", ",");
}

/** Whether the avatar was dropped on a page: nobody else is told of it. */
export function isPrivate(avatar: string): boolean {
  return DROPPED.test(avatar);
}

/** An address that names this page's own avatar too: handing it on is what shares the file. */
export function withOwnAvatar(address: string, avatar: string): string {
  const url = new URL(address);
  if (isPrivate(avatar)) url.searchParams.set("avatar", avatar);
  return url.href.replaceAll("%3A", ":").replaceAll("%2C", ",");
}

/** Whether the way from one query to another is a step to go back by. */
export function isStep(before: string, after: string): boolean {
  const [from, to] = [new URLSearchParams(before), new URLSearchParams(after)];
  return from.has("scene") && STEPS.some((name) => from.get(name) !== to.get(name));
}

export class AddressLine {
  /** The user has chosen something since the last step. */
  private chosen = false;

  /** @param onMove called with the query of the place that the back or forward button leads to */
  constructor(onMove: (query: URLSearchParams) => void) {
    window.addEventListener("popstate", () => {
      this.chosen = false;
      onMove(new URLSearchParams(location.search));
    });
  }

  /** The user chooses: what comes of it may be a step. */
  choose(): void {
    this.chosen = true;
  }

  /** Writes the place into the address line. */
  show(place: Place): void {
    const { search } = location;
    const query = queryOf(place, search);
    if (query === search) return;
    if (this.chosen && isStep(search, query)) {
      this.chosen = false;
      history.pushState(null, "", query);
    } else {
      history.replaceState(history.state, "", query);
    }
  }
}
