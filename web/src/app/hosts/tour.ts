/** What a guided tour does to the page: it walks, looks, says, and waits. */

import type { TourHost } from "../../going/tour";
import type { Deeds } from "../deeds";
import type { Reach } from "./reach";

export interface TourHostParts {
  readonly reach: Reach;
  readonly deeds: Deeds;
}

export function tourHost(parts: TourHostParts): TourHost {
  return {
    ...parts.reach,
    look: (view) => parts.deeds.do(`view:${view}`),
    after: (seconds, then) => {
      const timer = window.setTimeout(then, 1000 * seconds);
      return () => window.clearTimeout(timer);
    },
  };
}
