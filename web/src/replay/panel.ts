/** The panel of the replay: transport, timeline with its curves, the choice of runs. */

import { make } from "../ui/dom";
import { lengthWords } from "../texts/length";
import { text } from "../texts/texts";
import { drawChart, JOINT_COLORS, MARK_COLORS, type ChartData } from "./chart";
import { JOINT_NAMES } from "./curves";
import { MARK_KINDS, type MarkKind } from "./marks";
import { SPEEDS, type Player } from "./player";
import { SAVED_AS, type SavedAs } from "./save";
import "./replay.css";

/** How a second run is shown. */
export type Manner = "ghost" | "beside";

/** What the user does with the panel. */
export interface PanelListener {
  toggle(): void;
  step(steps: number): void;
  seek(time: number): void;
  setSpeed(speed: number): void;
  setLoop(loop: boolean): void;
  choose(id: number): void;
  compare(id: number | null, manner: Manner): void;
  filmOrEnd(): void;
  save(ending: SavedAs): void;
  close(): void;
}

/** A run in the lists. */
export interface Choice {
  readonly id: number;
  readonly title: string;
}

const ICONS = {
  play: "M6 3.5 16 10 6 16.5z",
  pause: "M6 4h3v12H6zM11 4h3v12h-3z",
  back: "M16 4.5 9 10l7 5.5zM5 4.5h2.5v11H5z",
  forward: "M4 4.5 11 10l-7 5.5zM12.5 4.5H15v11h-2.5z",
  begin: "M4 4h2v12H4zM16 4v12L7 10z",
} as const;

export class ReplayPanel {
  readonly element = make("section", { id: "replay", class: "chrome panel", "aria-label": text("replay.title") });
  private readonly canvas = make("canvas", { "aria-hidden": "true" });
  private readonly head = make("div", { class: "playhead", "aria-hidden": "true" });
  private readonly slider = make("input", { type: "range", min: "0", step: "any", "aria-label": text("replay.moment") });
  private readonly clock = make("output", { class: "clock" });
  private readonly gap = make("output", { class: "gap-now" });
  private readonly run = make("select", {});
  private readonly against = make("select", {});
  private readonly manner = make("select", { "aria-label": text("replay.against") });
  private readonly saving = make("select", {});
  private readonly speed = make("select", { "aria-label": text("replay.speed") });
  private readonly play = button("play", text("replay.play"), "replay-play");
  private readonly loop = make("button", { type: "button", class: "icon wide", "aria-pressed": "false", title: text("replay.loop") }, "↻");
  private readonly filming = make("button", { type: "button", class: "icon wide rec", "aria-pressed": "false", title: text("replay.film") }, "●");
  private readonly sharing = make("button", { type: "button", class: "plain share", hidden: "" }, text("replay.shareFilm"));
  private shareFilm: (() => void) | null = null;
  private data: ChartData | null = null;
  private playing: boolean | null = null;

  constructor(private readonly listener: PanelListener) {
    this.loop.setAttribute("aria-label", text("replay.loop"));
    this.filming.setAttribute("aria-label", text("replay.film"));
    this.element.append(this.choices(), this.timeline(), this.transport());
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
    this.listen();
  }

  /** The runs to choose from, and those that can be laid over the chosen one. */
  showChoices(runs: readonly Choice[], chosen: number, others: readonly Choice[], other: number | null): void {
    this.run.replaceChildren(...runs.map(({ id, title }) => new Option(title, String(id), false, id === chosen)));
    const none = new Option(text("replay.nothing"), "", false, other === null);
    this.against.replaceChildren(none, ...others.map(({ id, title }) => new Option(title, String(id), false, id === other)));
    this.against.disabled = others.length === 0;
    this.manner.disabled = other === null;
    this.manner.hidden = other === null;
  }

  showChart(data: ChartData): void {
    this.data = data;
    this.slider.max = String(data.seconds);
    this.redraw();
  }

  /** Brings the panel up to date; `clearance` in metres. */
  update({ time, duration, playing }: Player, clearance: number): void {
    this.slider.value = String(time);
    this.slider.setAttribute("aria-valuetext", `${time.toFixed(2)} s`);
    this.head.style.left = `${duration > 0 ? (100 * time) / duration : 0}%`;
    write(this.clock, `${time.toFixed(2)} / ${duration.toFixed(2)} s`);
    write(this.gap, Number.isFinite(clearance) ? lengthWords(clearance) : text("replay.near"));
    this.gap.classList.toggle("bad", clearance < 0);
    if (playing === this.playing) return;
    this.playing = playing;
    const label = text(playing ? "replay.pause" : "replay.play");
    this.play.querySelector("path")?.setAttribute("d", ICONS[playing ? "pause" : "play"]);
    this.play.setAttribute("aria-label", label);
    this.play.title = label;
  }

  showFilming(on: boolean): void {
    this.filming.setAttribute("aria-pressed", String(on));
    this.filming.title = text(on ? "replay.filming" : "replay.film");
  }

  /** Shows the button that sends a film on, or takes it away. */
  offerFilm(share: (() => void) | null): void {
    this.shareFilm = share;
    this.sharing.hidden = share === null;
  }

  /** Draws the curves anew, after a change of size or colours. */
  redraw(): void {
    if (this.data) drawChart(this.canvas, this.data);
  }

  private choices(): HTMLElement {
    for (const manner of ["ghost", "beside"] as const) this.manner.add(new Option(text(`replay.${manner}`), manner));
    this.saving.replaceChildren(new Option(text("replay.saveAs"), ""), ...SAVED_AS.map((ending) => new Option(`.${ending}`, ending)));
    const close = make("button", { type: "button", class: "icon close", "aria-label": text("replay.close"), title: `${text("replay.close")} (Esc)` }, "✕");
    close.addEventListener("click", () => this.listener.close());
    return make("div", { class: "choices" },
      make("label", { class: "run" }, make("span", {}, text("replay.run")), this.run),
      make("label", { class: "against" }, make("span", {}, text("replay.against")), this.against), this.manner,
      make("label", { class: "save" }, make("span", {}, text("replay.save")), this.saving), make("span", { class: "space" }), this.sharing, this.filming, close);
  }

  private timeline(): HTMLElement {
    const lanes = make("div", { class: "lanes" }, this.canvas, this.head);
    const seek = (event: PointerEvent) => {
      const { left, width } = lanes.getBoundingClientRect();
      this.listener.seek(((event.clientX - left) / width) * Number(this.slider.max));
    };
    lanes.addEventListener("pointerdown", (event) => {
      lanes.setPointerCapture(event.pointerId);
      seek(event);
    });
    lanes.addEventListener("pointermove", (event) => lanes.hasPointerCapture(event.pointerId) && seek(event));
    return make("div", { class: "timeline" }, lanes, this.slider);
  }

  private transport(): HTMLElement {
    for (const speed of SPEEDS) this.speed.add(new Option(speedTitle(speed), String(speed), speed === 1, speed === 1));
    const begin = button("begin", text("replay.begin"));
    const back = button("back", `${text("replay.back")} (,)`);
    const forward = button("forward", `${text("replay.forward")} (.)`);
    begin.addEventListener("click", () => this.listener.seek(0));
    back.addEventListener("click", () => this.listener.step(-1));
    forward.addEventListener("click", () => this.listener.step(1));
    const marks = MARK_KINDS.map((kind: MarkKind) => keyOf(MARK_COLORS[kind], text(`mark.${kind}`), "mark"));
    const joints = JOINT_NAMES.map((name) => keyOf(JOINT_COLORS[name], text(`joint.${name}`), "joint"));
    return make("div", { class: "transport" }, begin, back, this.play, forward, this.speed, this.loop, this.clock, this.gap,
      make("div", { class: "legend" }, ...marks, ...joints));
  }

  private listen(): void {
    const { listener } = this;
    this.play.addEventListener("click", () => listener.toggle());
    this.slider.addEventListener("input", () => listener.seek(Number(this.slider.value)));
    this.speed.addEventListener("change", () => listener.setSpeed(Number(this.speed.value)));
    this.loop.addEventListener("click", () => {
      const on = this.loop.getAttribute("aria-pressed") !== "true";
      this.loop.setAttribute("aria-pressed", String(on));
      listener.setLoop(on);
    });
    this.run.addEventListener("change", () => listener.choose(Number(this.run.value)));
    const compare = () => listener.compare(this.against.value === "" ? null : Number(this.against.value), this.manner.value as Manner);
    this.against.addEventListener("change", compare);
    this.manner.addEventListener("change", compare);
    this.filming.addEventListener("click", () => listener.filmOrEnd());
    this.sharing.addEventListener("click", () => this.shareFilm?.());
    this.saving.addEventListener("change", () => {
      const ending = SAVED_AS.find((one) => one === this.saving.value);
      this.saving.value = "";
      if (ending) listener.save(ending);
    });
  }
}

function button(icon: keyof typeof ICONS, label: string, id = ""): HTMLButtonElement {
  const made = make("button", { type: "button", class: "icon", "aria-label": label, title: label, ...(id ? { id } : {}) });
  made.innerHTML = `<svg viewBox="0 0 20 20" aria-hidden="true"><path d="${ICONS[icon]}" /></svg>`;
  return made;
}

function keyOf(color: string, title: string, kind: string): HTMLElement {
  const key = make("i", { class: kind });
  key.style.background = color;
  return make("span", { class: `${kind}-key` }, key, title);
}

function speedTitle(speed: number): string {
  return speed === 0.25 ? "¼×" : speed === 0.5 ? "½×" : `${speed}×`;
}

function write(element: HTMLElement, words: string): void {
  if (element.textContent !== words) element.textContent = words;
}
