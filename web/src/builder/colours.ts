/** The colours that things are shown in: their own, or those that the picture gives them in its order. */

import { PALETTES, type Theme } from "../stage/palette";
import type { Plan } from "./plan";

/** The colour of a plan's thing as "#rrggbb". */
export function shownColour({ things }: Plan, index: number, theme: Theme): string {
  const thing = things[index];
  if (thing?.color) return thing.color;
  const { obstacles } = PALETTES[theme];
  const colour = obstacles[drawnAt(things, index) % obstacles.length] ?? 0;
  return `#${colour.toString(16).padStart(6, "0")}`;
}

/** The colours that the page has now. */
export function shownTheme(): Theme {
  return document.documentElement.dataset["theme"] === "dark" ? "dark" : "light";
}

/** The place of a thing in the picture, where what moves comes after all that stands. */
function drawnAt(things: Plan["things"], index: number): number {
  const moves = (things[index]?.track.length ?? 0) > 0;
  const before = things.slice(0, index).filter(({ track }) => track.length > 0 === moves).length;
  return moves ? before + things.filter(({ track }) => track.length === 0).length : before;
}
