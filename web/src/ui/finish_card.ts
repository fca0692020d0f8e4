/** The card after the finish: what the crossing came to, and what to do next. */

import type { Crossed } from "../generated/messages";
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
    this.title.textContent = `Through in ${finish.crossed.seconds.toFixed(1)} s${record && finish.best !== null ? ": your best" : ""}`;
    this.facts.replaceChildren(...factsOf(finish).flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
    this.compare.textContent = finish.assist ? "Without assist" : "With assist";
    this.card.hidden = false;
  }

  hide(): void {
    this.card.hidden = true;
  }
}

/** The rows of the card. */
export function factsOf({ crossed, clearance, assist, best }: Finish): [string, string][] {
  const stuck = crossed.stuckTimes === 0 ? "never" : crossed.stuckTimes === 1 ? "once" : `${crossed.stuckTimes} times`;
  const least = clearance < 0 ? "passed through things" : Number.isFinite(clearance) ? `${(100 * clearance).toFixed(1)} cm` : "nothing near";
  const time = !assist ? "does not count without assist" : best === null ? "this is the first" : `${Math.min(best, crossed.seconds).toFixed(1)} s`;
  return [["Stuck", stuck], ["Least clearance", least], ["Best here", time]];
}
