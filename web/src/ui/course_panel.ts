/** Random courses: level and seed, and a new one at a press. */

import type { Catalog } from "../generated/messages";
import { courseName, courseOf } from "../results";
import { byId, setOptions, showValue } from "./dom";

const MOST_SEEDS = 10_000;

export class CoursePanel {
  private readonly section = byId("course", HTMLElement);
  private readonly level = byId("course-level", HTMLSelectElement);
  private readonly seed = byId("course-seed", HTMLInputElement);
  private shown = this.seed.value;
  private typed = false;

  /** @param go called with the name of a course that the user asks for */
  constructor(private readonly go: (scene: string) => void) {
    this.level.addEventListener("change", () => this.ask());
    this.seed.addEventListener("change", () => this.ask());
    const another = byId("course-new", HTMLButtonElement);
    // Who types a seed and then presses the button wants that one.
    another.addEventListener("pointerdown", () => {
      this.typed = this.seed.value !== this.shown;
    });
    another.addEventListener("click", () => {
      if (!this.typed) this.seed.value = String(Math.floor(Math.random() * MOST_SEEDS));
      this.typed = false;
      this.ask();
    });
  }

  showCatalog({ scenes }: Catalog): void {
    const levels = [...new Set(scenes.flatMap(({ name }) => courseOf(name)?.level ?? []))].map(String);
    setOptions(this.level, levels.map((level) => [level, level]));
    if (this.level.selectedIndex < 0) this.level.selectedIndex = 0;
    this.section.hidden = levels.length === 0;
  }

  /** Shows the course that one walks through; another scene leaves it as it was. */
  showScene(scene: string): void {
    const course = courseOf(scene);
    if (!course) return;
    this.level.value = String(course.level);
    this.shown = String(course.seed);
    showValue(this.seed, this.shown);
  }

  private ask(): void {
    if (this.seed.validity.valid) this.go(courseName(Number(this.level.value), Number(this.seed.value || 0)));
  }
}
