/** Why there is no way on, in one sentence. */

import type { Blocked } from "../generated/messages";
import { text } from "../texts/texts";
import { thingName } from "../texts/thing_names";

const MOST_NAMES = 3;

/** "No way on: beam 2 and crate 3 leave no posture at 0.8 m ahead". */
export function blockedSentence({ reason, obstacles, ahead }: Blocked): string {
  const near = ahead < 0.05;
  const metres = ahead.toFixed(1);
  const where = near ? text("blocked.here") : text("blocked.ahead", metres);
  if (obstacles.length === 0 || reason === "motion") return text("blocked.motion", where);
  const one = obstacles.length === 1;
  const what = reason === "noPosture" ? text("blocked.noPosture") : text("blocked.outOfReach");
  return text(one ? "blocked.one" : "blocked.many", listed(obstacles), what, near ? where : text("blocked.at", metres));
}

function listed(names: readonly string[]): string {
  if (names.length > MOST_NAMES) return text("list.more", joined(names.slice(0, MOST_NAMES - 1)), names.length - MOST_NAMES + 1);
  if (names.length === 1) return thingName(names[0] ?? "");
  return text("list.and", joined(names.slice(0, -1)), thingName(names.at(-1) ?? ""));
}

function joined(names: readonly string[]): string {
  return names.map(thingName).join(text("list.comma"));
}
