/** Build mode: brings the editor, its panel, the live check and the browser's drafts together; the stage shows the plan meanwhile. */

import { words } from "../app/words";
import type { SceneMessage } from "../generated/messages";
import type { Picture } from "../picture";
import { download } from "../replay/film";
import { sceneTitle } from "../texts/scene_titles";
import { text } from "../texts/texts";
import { thingName } from "../texts/thing_names";
import { make } from "../ui/dom";
import { Checker } from "./checker";
import { nameOf } from "./document";
import { Drafts } from "./drafts";
import { Editor } from "./editor";
import { linkOf } from "./link";
import { BuildPanel, type BuildPanelListener } from "./panel";
import { emptyPlan, type Plan } from "./plan";
import { previewOf } from "./preview";
import { fetchPlan, send, textOf } from "./wire";

/** What build mode needs of the page. */
export interface BuildHost {
  readonly picture: Picture;
  avatar(): string;
  say(level: "info" | "warning" | "error", words: string): void;
  /** The picture leaves so many pixels to the panel: at the bottom, and at the right. */
  dock(bottom: number, right: number): void;
  /** The avatar is to walk in this scene. */
  walkIn(scene: { readonly name: string; readonly title: string }): void;
  /** The live walk comes back. */
  closed(): void;
}

/** What is shown, for tests and the curious. */
export interface BuildState {
  readonly title: string;
  readonly things: readonly string[];
  readonly selected: string | null;
  readonly tool: string;
  readonly verdict: string;
}

const ON_TOP = window.matchMedia("(max-width: 700px) and (orientation: portrait)");

export class Build implements BuildPanelListener {
  active = false;
  /** What is on its way into the editor; null once it is there. */
  private opening: symbol | null = null;
  private readonly editor: Editor;
  private readonly panel: BuildPanel;
  private readonly checker: Checker;
  private readonly drafts = new Drafts(localStore());
  private readonly file = make("input", { type: "file", accept: ".json,application/json", hidden: "", "aria-label": text("build.open") });
  private previewed: Plan | null = null;

  constructor(private readonly host: BuildHost) {
    this.editor = new Editor(emptyPlan(text("build.untitled")), (kind) => text(`build.${kind}`), () => this.changed());
    this.checker = new Checker(() => host.avatar(), () => this.draw());
    this.panel = new BuildPanel(this.editor, this);
    this.panel.element.append(this.file);
    this.file.addEventListener("change", () => {
      const chosen = this.file.files?.[0];
      if (chosen) void this.appear(async () => read(await chosen.text()));
      this.file.value = "";
    });
    new ResizeObserver(() => this.leaveRoom()).observe(this.panel.element);
    window.addEventListener("keydown", (event) => this.key(event), true);
  }

  get state(): BuildState | null {
    if (!this.active || this.opening) return null;
    const { plan, selected, tool } = this.editor;
    const { verdict } = this.checker;
    const walked = verdict.state === "walked" ? (verdict.walk.passed ? "feasible" : "infeasible") : verdict.state;
    return { title: plan.title, things: plan.things.map(({ name }) => name), selected: selected && JSON.stringify(selected), tool, verdict: walked };
  }

  get plan(): Plan {
    return this.editor.plan;
  }

  /** Opens build mode with the scene that is shown, or with an empty one where that cannot be built upon. */
  async show(scene: SceneMessage | null): Promise<void> {
    await this.appear(async () => (scene ? inOwnWords(await fetchPlan(scene.name)) : null));
  }

  /** Opens build mode with a scene as text. */
  async showText(scene: string): Promise<void> {
    await this.appear(() => read(scene));
  }

  /** The server answers again. */
  serverBack(): void {
    if (this.active) this.checker.again();
  }

  close(): void {
    if (!this.active) return;
    this.checker.end();
    this.active = false;
    this.opening = null;
    this.previewed = null;
    this.panel.element.remove();
    document.body.classList.remove("building");
    this.host.dock(0, 0);
    this.host.closed();
  }

  // What the user does.

  walk(): void {
    void this.tried(async () => {
      const choice = await send(this.editor.plan);
      this.close();
      this.host.walkIn(choice);
    });
  }

  save(): void {
    const { plan } = this.editor;
    download(new Blob([textOf(plan)], { type: "application/json" }), `${nameOf(plan.title)}.json`);
  }

  open(): void {
    this.file.click();
  }

  share(): void {
    void this.tried(async () => {
      const link = await linkOf(JSON.stringify(JSON.parse(textOf(this.editor.plan))), location.href);
      if (!link) this.host.say("warning", text("build.tooLong"));
      else {
        history.replaceState(history.state, "", link);
        const copied = await navigator.clipboard?.writeText(link).then(() => true, () => false);
        this.host.say("info", copied ? text("build.linked") : text("build.link", link));
      }
    });
  }

  anew(): void {
    this.editor.open(emptyPlan(text("build.untitled")));
    this.panel.board.fit();
  }

  draft(title: string): void {
    const found = this.drafts.all().find((plan) => plan.title === title);
    if (!found) return;
    this.editor.open(found);
    this.panel.board.fit();
  }

  toggleCheck(): void {
    this.checker.toggle();
    this.draw();
  }

  /** Comes up, and opens what is fetched (null: what was open before); nothing is drawn, edited or walked until it is there. */
  private async appear(fetched: () => Promise<Plan | null>): Promise<void> {
    if (!this.active) {
      document.body.append(this.panel.element);
      document.body.classList.add("building");
    }
    const opening = (this.opening = Symbol());
    this.active = true;
    this.panel.element.inert = true;
    this.leaveRoom();
    this.draw();
    await this.tried(async () => {
      const plan = await fetched();
      if (plan && this.opening === opening) this.editor.open(plan);
    });
    if (this.opening !== opening) return;
    this.opening = null;
    this.panel.element.inert = false;
    this.panel.showDrafts(this.drafts.all().map(({ title }) => title));
    this.changed();
    this.panel.board.fit();
    this.panel.board.element.focus({ preventScroll: true });
  }

  private changed(): void {
    const { plan } = this.editor;
    if (!this.active || this.opening) return;
    if (plan !== this.previewed) {
      this.previewed = plan;
      this.host.picture.showScene(previewOf(plan));
      if (this.editor.canUndo) this.drafts.keep(plan);
      this.checker.look(plan);
    }
    this.draw();
  }

  private draw(): void {
    if (this.active) this.panel.draw(this.opening ? { state: "opening" } : this.checker.verdict, this.checker.isOn);
  }

  /** Keys that nothing else has are the board's. */
  private key(event: KeyboardEvent): void {
    const { activeElement } = document;
    if (this.active && !this.opening && (activeElement === document.body || activeElement?.id === "view")) this.panel.board.key(event);
  }

  private leaveRoom(): void {
    if (!this.active) return;
    const { offsetWidth, offsetHeight } = this.panel.element;
    this.host.dock(ON_TOP.matches ? offsetHeight : 0, ON_TOP.matches ? 0 : offsetWidth);
  }

  /** Does something that may fail, and says why it did. */
  private async tried(deed: () => Promise<void>): Promise<void> {
    try {
      await deed();
    } catch (error) {
      this.host.say("error", words(error));
    }
  }
}

/** The server reads what comes from outside; what it hands back is a plan. */
async function read(scene: string): Promise<Plan> {
  return fetchPlan((await send(scene)).name);
}

/** A plan with the names of the scenes that come along in the page's language. */
function inOwnWords(plan: Plan): Plan {
  return { ...plan, title: sceneTitle(plan.title), things: plan.things.map((thing) => ({ ...thing, name: thingName(thing.name) })) };
}

function localStore(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}
