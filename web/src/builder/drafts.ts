/** Plans that this browser keeps, by their titles, the newest first. */

import type { Plan } from "./plan";

const STORE = "elbowroom.drafts";
const MOST = 20;
const LARGEST = 2_000_000;

export class Drafts {
  constructor(private readonly store: Storage | null) {}

  all(): readonly Plan[] {
    try {
      const kept: unknown = JSON.parse(this.store?.getItem(STORE) ?? "[]");
      return Array.isArray(kept) ? kept.filter(isPlan).map(completed) : [];
    } catch {
      return [];
    }
  }

  /** Keeps a plan in place of the one of the same title; a browser that stores nothing is no error. */
  keep(plan: Plan): void {
    const kept = [plan, ...this.all().filter(({ title }) => title !== plan.title)].slice(0, MOST);
    while (kept.length > 1 && JSON.stringify(kept).length > LARGEST) kept.pop();
    this.write(kept);
  }

  drop(title: string): void {
    this.write(this.all().filter((plan) => plan.title !== title));
  }

  private write(kept: readonly Plan[]): void {
    try {
      this.store?.setItem(STORE, JSON.stringify(kept));
    } catch {
      return;
    }
  }
}

/** What is stored was written by this page, or by an older one. */
function isPlan(value: unknown): value is Omit<Plan, "tour"> & Partial<Plan> {
  const plan = value as Partial<Plan> | null;
  return typeof plan?.title === "string" && Array.isArray(plan.things) && typeof plan.start?.x === "number"
    && typeof plan.finish?.width === "number" && Array.isArray(plan.ground?.size);
}

/** A draft of an older page with what plans have today. */
function completed(plan: Omit<Plan, "tour"> & Partial<Plan>): Plan {
  return { ...plan, tour: (plan.tour ?? []).map((stop) => ({ ...stop, height: stop.height ?? null })) };
}
