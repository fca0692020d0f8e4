/** The live check: some time after an edit the avatar walks the plan unseen; a newer edit calls that off. */

import { words } from "../app/words";
import type { UnseenWalk } from "../generated/messages";
import type { Plan } from "./plan";
import { walkUnseen } from "./wire";

/** What is known of the present plan. */
export type Verdict =
  | { readonly state: "opening" | "off" | "waiting" | "walking" }
  | { readonly state: "walked"; readonly walk: UnseenWalk }
  | { readonly state: "wrong"; readonly words: string };

const REST = 1200;

export class Checker {
  verdict: Verdict = { state: "off" };
  private on = true;
  private timer = 0;
  private call: AbortController | null = null;
  private plan: Plan | null = null;

  constructor(private readonly avatar: () => string, private readonly changed: () => void) {}

  get isOn(): boolean {
    return this.on;
  }

  /** Switches the check on or off. */
  toggle(): void {
    const { plan } = this;
    this.on = !this.on;
    this.plan = null;
    if (plan) this.look(plan);
  }

  /** Looks at a plan, if it is another one. */
  look(plan: Plan): void {
    if (plan === this.plan) return;
    this.end();
    this.plan = plan;
    this.say({ state: this.on ? "waiting" : "off" });
    if (this.on) this.timer = window.setTimeout(() => void this.walk(plan), REST);
  }

  /** Looks once more where the last look failed: the server may be back. */
  again(): void {
    const { plan } = this;
    if (this.verdict.state !== "wrong" || !plan) return;
    this.plan = null;
    this.look(plan);
  }

  /** Calls off what is under way. */
  end(): void {
    window.clearTimeout(this.timer);
    this.call?.abort();
    this.call = null;
    this.plan = null;
  }

  private async walk(plan: Plan): Promise<void> {
    const call = (this.call = new AbortController());
    this.say({ state: "walking" });
    try {
      const walk = await walkUnseen(plan, this.avatar(), call.signal);
      if (this.call === call) this.say({ state: "walked", walk });
    } catch (error) {
      if (this.call === call) this.say({ state: "wrong", words: words(error) });
    }
  }

  private say(verdict: Verdict): void {
    this.verdict = verdict;
    this.changed();
  }
}
