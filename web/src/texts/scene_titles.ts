/** Titles of scenes in the page's language: those that come with the program, and courses; others stay as they were given. */

import { text } from "./texts";
import { worded } from "./worded";

/** As the server calls a course. */
const COURSE = /^Gauntlet, level (\d+) \(([^)]+)\), seed (\d+)$/;

/** A scene's title in the page's language. */
export function sceneTitle(title: string): string {
  const [, level, kind, seed] = COURSE.exec(title) ?? [];
  return level && kind && seed ? text("scene.course", level, worded(kind), seed) : worded(title);
}
