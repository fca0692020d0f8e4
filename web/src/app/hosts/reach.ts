/** What parts that do not know the page reach of it: the picture, the server, the one who plays, and whether the walk is live. */

import type { ClientMessage, Notice } from "../../generated/messages";
import type { Session } from "../../net/session";
import type { Picture } from "../../picture";
import type { Notices } from "../../ui/notices";
import type { Modes } from "../modes";

export interface Reach {
  readonly picture: Picture;
  send(message: ClientMessage): void;
  say(level: Notice["level"], said: string): void;
  /** Whether one walks now: not while a run is replayed, or a scene is built. */
  walks(): boolean;
}

export interface ReachParts {
  readonly picture: Picture;
  readonly session: Session;
  readonly notices: Notices;
  readonly modes: Modes;
}

export function reachOf(parts: ReachParts): Reach {
  return {
    picture: parts.picture,
    send: (message) => parts.session.send(message),
    say: (level, said) => parts.notices.show(level, said),
    walks: () => parts.modes.live,
  };
}
