/** Where things are pushed, and who knows of it. */

import type { Pushing, PushingHost } from "../../pushing/pushing";
import type { Frames } from "../frames";
import type { LiveWalk } from "../live_walk";
import type { Modes } from "../modes";
import type { Reach } from "./reach";

export interface PushingHostParts {
  readonly view: HTMLElement;
  readonly reach: Reach;
  readonly frames: Frames;
  readonly live: LiveWalk;
  readonly modes: Modes;
  readonly pushing: Pushing;
}

export function pushingHost(parts: PushingHostParts): PushingHost {
  return {
    ...parts.reach,
    view: parts.view,
    pose: () => parts.frames.pose,
    changed: () => {
      const { live, modes, pushing, reach } = parts;
      live.loose = pushing.loose;
      modes.noteLive();
      if (modes.live) reach.picture.world.loosen(live.loose);
    },
  };
}
