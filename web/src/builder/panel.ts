/** The panel of build mode: tools, the board, the fields of what is selected, and what can be done with the whole. */

import { text, type TextName } from "../texts/texts";
import { make } from "../ui/dom";
import { Board } from "./board";
import type { Verdict } from "./checker";
import { SNAPS, type Editor, type Tool } from "./editor";
import { Form } from "./form";
import { KINDS } from "./shapes";
import { verdictWords } from "./verdict_words";
import { ZOOM } from "./board_keys";
import "./build.css";

/** What the user does with the panel that is no edit. */
export interface BuildPanelListener {
  walk(): void;
  save(): void;
  open(): void;
  share(): void;
  anew(): void;
  draft(title: string): void;
  toggleCheck(): void;
  close(): void;
}

const ICONS = {
  box: "M10 2.5 17 6v8l-7 3.5L3 14V6zM3 6l7 3.5L17 6M10 9.5v8",
  sphere: "M10 3a7 7 0 1 1 0 14 7 7 0 0 1 0-14M3 10c3 2.4 11 2.4 14 0",
  capsule: "M6.5 6.5a3.5 3.5 0 0 1 7 0v7a3.5 3.5 0 0 1-7 0z",
  cylinder: "M4.5 5.5c0-3 11-3 11 0v9c0 3-11 3-11 0zM4.5 5.5c0 3 11 3 11 0",
  hull: "M3 15.5h14V6z",
  track: "M4 15.5c0-6 12-4 12-11M4 15.5h.01M16 4.5h.01",
  stop: "M10 17.5S4 11.7 4 8a6 6 0 0 1 12 0c0 3.7-6 9.5-6 9.5M10 6.2a1.8 1.8 0 1 1 0 3.6 1.8 1.8 0 0 1 0-3.6",
  undo: "M7 4.5 3.5 8 7 11.5M3.5 8H12a4.5 4.5 0 0 1 0 9H8",
  redo: "M13 4.5 16.5 8 13 11.5M16.5 8H8a4.5 4.5 0 0 0 0 9h4",
  copy: "M7 7h9v9H7zM4 13V4h9",
  remove: "M4 6h12M8 6V4h4v2M6 6l1 10.5h6L14 6",
  nearer: "M8.5 3a5.5 5.5 0 1 1 0 11 5.5 5.5 0 0 1 0-11M13 13l4 4M6 8.5h5M8.5 6v5",
  farther: "M8.5 3a5.5 5.5 0 1 1 0 11 5.5 5.5 0 0 1 0-11M13 13l4 4M6 8.5h5",
  fit: "M3 7V3h4M17 7V3h-4M3 13v4h4M17 13v4h-4",
} as const;

export class BuildPanel {
  readonly element = make("section", { id: "build", class: "chrome panel", "aria-label": text("build.title") });
  readonly board: Board;
  private readonly form: Form;
  private readonly titleInput = make("input", { type: "text", maxlength: "80", class: "title", "aria-label": text("build.sceneTitle") });
  private readonly verdict = make("p", { class: "verdict", role: "status" });
  private readonly check = make("button", { type: "button", class: "icon wide", title: text("build.checkTitle") }, text("build.check"));
  private readonly sideButton = make("button", { type: "button", class: "icon wide" });
  private readonly snap = make("select", { "aria-label": text("build.snap"), title: text("build.snap") });
  private readonly drafts = make("select", { "aria-label": text("build.drafts") });
  private readonly tools = new Map<Tool, HTMLButtonElement>();
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly copy: HTMLButtonElement;
  private readonly remove: HTMLButtonElement;

  constructor(private readonly editor: Editor, private readonly listener: BuildPanelListener) {
    this.board = new Board(editor);
    this.form = new Form(editor);
    this.undo = this.button("undo", `${text("build.undo")} (Ctrl+Z)`, () => editor.undo());
    this.redo = this.button("redo", `${text("build.redo")} (Ctrl+Y)`, () => editor.redo());
    this.copy = this.button("copy", `${text("build.copy")} (C)`, () => editor.copy());
    this.remove = this.button("remove", `${text("build.remove")} (Del)`, () => editor.remove());
    this.element.append(this.head(), this.toolbar(), this.board.element, this.form.element, this.verdict, this.foot());
    this.listen();
  }

  draw(verdict: Verdict, checking: boolean): void {
    const { editor } = this;
    for (const [tool, button] of this.tools) button.setAttribute("aria-pressed", String(editor.tool === tool));
    const track = this.tools.get("track");
    if (track) track.disabled = editor.index === null;
    this.undo.disabled = !editor.canUndo;
    this.redo.disabled = !editor.canRedo;
    this.copy.disabled = editor.index === null;
    this.remove.disabled = editor.index === null && editor.selected?.what !== "stop";
    this.sideButton.textContent = text(editor.side === "top" ? "build.top" : "build.side");
    this.check.setAttribute("aria-pressed", String(checking));
    if (document.activeElement !== this.titleInput) this.titleInput.value = editor.plan.title;
    const words = verdictWords(verdict, editor.tool);
    if (this.verdict.textContent !== words) this.verdict.textContent = words;
    this.verdict.dataset["state"] = verdict.state === "walked" ? (verdict.walk.passed ? "good" : "bad") : verdict.state === "wrong" ? "bad" : "";
    const stuck = verdict.state === "walked" && verdict.walk.decided && !verdict.walk.passed;
    this.board.showMark(stuck ? [verdict.walk.x, verdict.walk.z] : null);
    this.board.draw();
    this.form.draw();
  }

  showDrafts(titles: readonly string[]): void {
    this.drafts.replaceChildren(new Option(text("build.drafts"), ""), ...titles.map((title) => new Option(title, title)));
    this.drafts.disabled = titles.length === 0;
  }

  private head(): HTMLElement {
    const close = make("button", { type: "button", class: "icon close", "aria-label": text("build.close"), title: `${text("build.close")} (Esc)` }, "✕");
    close.addEventListener("click", () => this.listener.close());
    const walk = make("button", { type: "button", class: "walk", title: text("build.walkTitle") }, text("build.walk"));
    walk.addEventListener("click", () => this.listener.walk());
    return make("header", {}, this.titleInput, this.undo, this.redo, walk, close);
  }

  private toolbar(): HTMLElement {
    const kinds = KINDS.map((kind, i) => this.tool(kind, `${text(`build.${kind}`)} (${i + 1})`));
    const track = this.tool("track", `${text("build.track")} (T)`);
    const stop = this.tool("stop", `${text("build.stop")} (S)`);
    const nearer = this.button("nearer", `${text("build.nearer")} (I)`, () => this.board.zoom(1 / ZOOM));
    const farther = this.button("farther", `${text("build.farther")} (O)`, () => this.board.zoom(ZOOM));
    const fit = this.button("fit", `${text("build.fit")} (Home)`, () => this.board.fit());
    for (const metres of SNAPS) this.snap.add(new Option(metres === 0 ? text("build.noSnap") : `${metres * 100} cm`, String(metres)));
    this.snap.value = String(this.editor.snap);
    this.sideButton.title = `${text("build.look")} (V)`;
    return make("div", { class: "tools", role: "toolbar", "aria-label": text("build.tools") },
      ...kinds, track, stop, make("i", { class: "gap", "aria-hidden": "true" }), this.copy, this.remove, make("i", { class: "gap", "aria-hidden": "true" }),
      this.sideButton, nearer, farther, fit, this.snap, this.check);
  }

  private foot(): HTMLElement {
    const deeds: readonly (readonly [TextName, () => void])[] = [
      ["build.save", () => this.listener.save()], ["build.open", () => this.listener.open()], ["build.share", () => this.listener.share()],
      ["build.new", () => this.listener.anew()],
    ];
    const buttons = deeds.map(([name, deed]) => {
      const button = make("button", { type: "button", class: "plain" }, text(name));
      button.addEventListener("click", deed);
      return button;
    });
    return make("footer", {}, ...buttons, this.drafts);
  }

  private tool(tool: Tool, title: string): HTMLButtonElement {
    const made = this.button(tool as keyof typeof ICONS, title, () => this.editor.take(this.editor.tool === tool ? "select" : tool));
    this.tools.set(tool, made);
    return made;
  }

  private button(icon: keyof typeof ICONS, title: string, deed: () => void): HTMLButtonElement {
    const made = make("button", { type: "button", class: "icon", "aria-label": title, title });
    made.innerHTML = `<svg viewBox="0 0 20 20" aria-hidden="true"><path class="line" d="${ICONS[icon]}" /></svg>`;
    made.addEventListener("click", deed);
    return made;
  }

  private listen(): void {
    const { editor, listener } = this;
    this.titleInput.addEventListener("change", () => {
      const title = this.titleInput.value.trim();
      if (title) editor.put({ ...editor.plan, title });
      else this.titleInput.value = editor.plan.title;
    });
    this.sideButton.addEventListener("click", () => {
      editor.look(editor.side === "top" ? "side" : "top");
      this.board.fit();
    });
    this.snap.addEventListener("change", () => editor.snapTo(Number(this.snap.value)));
    this.check.addEventListener("click", () => listener.toggleCheck());
    this.drafts.addEventListener("change", () => {
      listener.draft(this.drafts.value);
      this.drafts.value = "";
    });
  }
}
