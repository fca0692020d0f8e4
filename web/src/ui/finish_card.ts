/** The card after the finish: what the crossing came to, and what to do next. */

import type { Crossed } from "../generated/messages";
import { lengthWords } from "../texts/length";
import { worded } from "../texts/worded";
import { text } from "../texts/texts";
import { byId, make } from "./dom";

/** A crossing as the card tells it. */
export interface Finish {
  readonly crossed: Crossed;
  /** The least distance on the way, metres; infinite where nothing was near. */
  readonly clearance: number;
  readonly assist: boolean;
  /** The best time before this one, seconds; null if there is none or it does not count. */
  readonly best: number | null;
}

/** What its buttons do. */
export type FinishDeed = "again" | "next" | "compare" | "replay";

export class FinishCard {
  private readonly card = byId("finish", HTMLElement);
  private readonly title = byId("finish-title", HTMLElement);
  private readonly facts = byId("finish-facts", HTMLElement);
  private readonly compare = byId("finish-compare", HTMLButtonElement);

  constructor(act: (deed: FinishDeed) => void) {
    for (const deed of ["again", "next", "compare", "replay"] as const) {
      byId(`finish-${deed}`, HTMLButtonElement).addEventListener("click", () => {
        this.hide();
        act(deed);
      });
    }
    byId("finish-close", HTMLButtonElement).addEventListener("click", () => this.hide());
  }

  show(finish: Finish): void {
    const record = finish.assist && (finish.best === null || finish.crossed.seconds < finish.best);
    this.title.textContent = text(record && finish.best !== null ? "finish.best" : "finish.through", finish.crossed.seconds.toFixed(1));
    this.facts.replaceChildren(...factsOf(finish).flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
    this.compare.textContent = worded(finish.assist ? "Without assist" : "With assist");
    this.card.hidden = false;
  }

  hide(): void {
    this.card.hidden = true;
  }
}

/** The rows of the card. */
export function factsOf({ crossed, clearance, assist, best }: Finish): [string, string][] {
  const stuck = crossed.stuckTimes === 0 ? worded("never") : crossed.stuckTimes === 1 ? worded("once") : text("times", crossed.stuckTimes);
  const least = clearance < 0 ? worded("passed through things") : Number.isFinite(clearance) ? lengthWords(clearance) : worded("nothing near");
  const time = !assist ? worded("does not count without assist") : best === null ? worded("this is the first") : `${Math.min(best, crossed.seconds).toFixed(1)} s`;
  return [[worded("Stuck"), stuck], [worded("Least clearance"), least], [worded("Best here"), time]];
}
