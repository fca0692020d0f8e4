/** What things in scenes are called, in the page's language: those that come with the program; others stay as they were given. */

import { spoken } from "./texts";
import { worded } from "./worded";

/** "hanging panel, left" or "beam 2" in the page's language. */
export function thingName(name: string): string {
  if (spoken() === "en") return name;
  const [thing = "", ...where] = name.split(", ").map((part) => part.replace(/^(.*?)( \d+)?$/, (_, word: string, number = "") => worded(word) + number));
  return where.length > 0 ? `${thing}（${where.join("、")}）` : thing;
}
