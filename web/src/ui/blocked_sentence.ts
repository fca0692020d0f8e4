/** Why there is no way on, in one sentence. */

import type { Blocked } from "../generated/messages";

const MOST_NAMES = 3;

/** "No way on: beam 2 and crate 3 leave no posture at 0.8 m ahead". */
export function blockedSentence({ reason, obstacles, ahead }: Blocked): string {
  const where = ahead < 0.05 ? "here" : `${ahead.toFixed(1)} m ahead`;
  if (obstacles.length === 0 || reason === "motion") return `No way on: every motion that was tried touches ${where}`;
  const verb = obstacles.length === 1 ? "leaves" : "leave";
  const what = reason === "noPosture" ? "no posture" : "no posture in reach";
  return `No way on: ${listed(obstacles)} ${verb} ${what} ${where === "here" ? "here" : `at ${where}`}`;
}

function listed(names: readonly string[]): string {
  if (names.length > MOST_NAMES) return `${names.slice(0, MOST_NAMES - 1).join(", ")} and ${names.length - MOST_NAMES + 1} more`;
  if (names.length === 1) return names[0] ?? "";
  return `${names.slice(0, -1).join(", ")} and ${names.at(-1) ?? ""}`;
}
