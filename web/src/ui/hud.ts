/** The small table of numbers in the corner. */

import type { Status } from "../generated/messages";
import { lengthWords } from "../texts/length";
import { text } from "../texts/texts";
import { worded } from "../texts/worded";
import { byId, make } from "./dom";

/** What the page itself measures. */
export interface PageNumbers {
  readonly fps: number;
  readonly frameMsP50: number;
  readonly frameMsP95: number;
  readonly roundTripMs: number;
  readonly clearance: number;
  readonly planner: string;
}

export const ROWS = [
  ["queue", "Queue", ""],
  ["planning", "Planning", ""],
  ["answer", "Answer", "extra"],
  ["checks", "Checks", ""],
  ["serverFrame", "Server frame", "extra"],
  ["pageFrame", "Page frame", "extra"],
  ["line", "Round trip", "extra"],
  ["clearance", "Clearance", ""],
  ["crossed", "Crossed", ""],
  ["stuck", "Stuck", ""],
] as const;

/** A longer queue is told in figures alone. */
const MOST_PIPS = 10;

type RowName = (typeof ROWS)[number][0];

export class Hud {
  private readonly cells = new Map<RowName, HTMLElement>();
  private readonly pips = make("span", { class: "pips", "aria-hidden": "true" });
  private readonly queueText = document.createTextNode("");
  private readonly planList = make("dl", { class: "plan" });

  constructor() {
    const list = make("dl");
    for (const [name, title, kind] of ROWS) {
      const cell = make("dd", { class: kind }, "–");
      this.cells.set(name, cell);
      list.append(make("dt", { class: kind }, worded(title)), cell);
    }
    this.cells.get("queue")?.replaceChildren(this.pips, this.queueText);
    this.planList.hidden = true;
    byId("hud", HTMLElement).append(list, this.planList);
  }

  update(status: Status, page: PageNumbers, showPlan: boolean): void {
    this.showQueue(status.queueFill, status.queueSize);
    this.set("planning", `${page.planner} · ${status.planningMs.toFixed(1)} ms`);
    this.set("answer", answerText(status));
    this.set("checks", status.checks.toLocaleString("en"));
    this.set("serverFrame", spread(status.frameMsP50, status.frameMsP95));
    this.set("pageFrame", `${page.fps.toFixed(0)} fps · ${spread(page.frameMsP50, page.frameMsP95)}`);
    this.set("line", Number.isNaN(page.roundTripMs) ? "–" : `${page.roundTripMs.toFixed(0)} ms`);
    this.set("clearance", clearanceText(page.clearance), page.clearance < 0 ? "bad" : "");
    this.set("crossed", String(status.crossed), status.crossed > 0 ? "good" : "");
    this.set("stuck", String(status.stuckTimes), status.stuck ? "bad" : "");
    this.planList.hidden = !showPlan;
    if (showPlan) this.showPlan(status);
  }

  private set(name: RowName, text: string, tone = ""): void {
    const cell = this.cells.get(name);
    if (!cell) return;
    if (cell.textContent !== text) cell.textContent = text;
    cell.classList.toggle("bad", tone === "bad");
    cell.classList.toggle("good", tone === "good");
  }

  private showQueue(fill: number, size: number): void {
    const pips = size <= MOST_PIPS ? size : 0;
    if (this.pips.children.length !== pips) this.pips.replaceChildren(...Array.from({ length: pips }, () => make("i")));
    [...this.pips.children].forEach((pip, i) => pip.classList.toggle("full", i < fill));
    this.queueText.data = `${Math.min(fill, size)}/${size}`;
  }

  private showPlan(status: Status): void {
    const rows: [string, string, string][] = [
      [worded("Phase"), words(status.phase), ""],
      [worded("Root"), words(status.rootKind), ""],
      [worded("Plan"), words(status.planStatus), tone(status.planStatus)],
      [worded("Plans"), plansText(status), ""],
      [worded("Looks ahead"), `${status.lookAhead.toFixed(1)} s`, ""],
    ];
    for (const group of status.groups) {
      const cost = text("plan.cost", group.checks.toLocaleString("en"), group.ms.toFixed(1));
      rows.push([title(group.group), `${words(group.status)} · ${cost}`, tone(group.status)]);
    }
    this.planList.replaceChildren(
      ...rows.flatMap(([title, text, tone]) => [make("dt", {}, title), make("dd", { class: tone }, text)]),
    );
  }
}

function spread(p50: number, p95: number): string {
  return `${p50.toFixed(1)} / ${p95.toFixed(1)} ms`;
}

/** How long a new command waits until the motion is planned for it. */
function answerText({ answerMs, lateMsP99 }: Status): string {
  const answer = answerMs ? `${answerMs[0].toFixed(0)} ms` : "–";
  return `${answer} · ${text("plan.framesLate", lateMsP99.toFixed(0))}`;
}

function plansText({ plans, plansFailed, latePlans }: Status): string {
  return text("plan.count", plans - plansFailed, plans) + (latePlans > 0 ? text("plan.late", latePlans) : "");
}

function clearanceText(clearance: number): string {
  if (!Number.isFinite(clearance)) return worded("free");
  return clearance < 0 ? worded("touching") : lengthWords(clearance);
}

function tone(status: string): string {
  return status === "" || status.toUpperCase() === "FOUND" ? "" : "bad";
}

function words(status: string): string {
  return status ? worded(status.toLowerCase().replaceAll("_", " ")) : "–";
}

/** A group's label in words: "leftArm" is "left arm". */
function title(group: string): string {
  return worded(group.replace(/[A-Z]/g, (letter) => ` ${letter.toLowerCase()}`));
}
