/** The server is asked only for the data that is drawn. */

import type { Session } from "../net/session";
import type { LiveWalk } from "./live_walk";
import type { Taste } from "./taste";

export interface SubscriptionParts {
  readonly session: Session;
  readonly live: LiveWalk;
  readonly taste: Taste;
}

export class Subscription {
  constructor(private readonly parts: SubscriptionParts) {}

  /** Asks for what is drawn now: after a change of settings, avatar or overlays. */
  renew(): void {
    const { session, live, taste: { preferences: { overlays } } } = this.parts;
    const assist = session.settings?.assist ?? true;
    session.subscribe({
      capsules: !assist || live.bodyIsAvatar || overlays.has("capsules") || overlays.has("nearest"),
      plan: overlays.has("path") || overlays.has("ghosts") || overlays.has("goal"),
    });
  }
}
