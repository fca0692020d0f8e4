/** The menu and the playback bar: shows the settings in force and reports what the user chooses. */

import { VIEW_NAMES, VIEWS, type ViewName } from "../camera/views";
import type { Catalog, Configure, Settings } from "../generated/messages";
import type { Action } from "../input/action";
import { OVERLAY_TITLES, OVERLAYS, type OverlayName } from "../overlays/overlay_names";
import type { Preferences } from "../preferences";
import { worded } from "../texts/worded";
import { ClipPanel } from "./clip_panel";
import { CoursePanel } from "./course_panel";
import { byId, make, setOptions, showValue } from "./dom";
import { sceneTitle } from "../texts/scene_titles";

/** What the user does with the menu. */
export interface MenuListener {
  configure(change: Omit<Configure, "type">): void;
  prefer(change: Partial<Preferences>): void;
  overlay(name: OverlayName, on: boolean): void;
  files(files: readonly File[]): void;
  /** The open menu covers so many pixels at the right of the view; 0 where it is closed or only a drawer. */
  menuCovers(pixels: number): void;
  action(action: Action): void;
}

const NARROW = "(max-width: 900px), (max-height: 540px)";

export class Menu {
  readonly clips: ClipPanel;
  /** The names of the scenes in the list, in its order. */
  offered: readonly string[] = [];
  private readonly courses: CoursePanel;
  private readonly panel = byId("menu", HTMLElement);
  private readonly button = byId("menu-button", HTMLButtonElement);
  private readonly scene = byId("scene", HTMLSelectElement);
  private readonly avatar = byId("avatar", HTMLSelectElement);
  private readonly planner = byId("planner", HTMLSelectElement);
  private readonly queue = byId("queue", HTMLInputElement);
  private readonly speed = byId("speed", HTMLInputElement);
  private readonly style = byId("style", HTMLSelectElement);
  /** The speeds that the styles like, m/s, by their names. */
  private liked = new Map<string, number>();
  private readonly file = byId("file", HTMLInputElement);
  private readonly hud = byId("hud-shown", HTMLInputElement);
  private readonly inset = byId("inset-shown", HTMLInputElement);
  private readonly sound = byId("sound-on", HTMLInputElement);
  private readonly narrow = window.matchMedia(NARROW);
  private readonly checks = new Map<OverlayName, HTMLInputElement>();

  constructor(private readonly listener: MenuListener, preferences: Preferences) {
    this.clips = new ClipPanel((change) => listener.configure(change));
    this.courses = new CoursePanel((scene) => listener.configure({ scene }));
    this.listenToLists();
    this.listenToSliders();
    this.listenToStyle();
    this.listenToFile();
    this.addViews();
    this.listenToButtons();
    this.addOverlays();
    this.bindPreferences(preferences);
    this.setOpen(!this.narrow.matches);
    this.narrow.addEventListener("change", () => this.setOpen(!this.narrow.matches));
    byId("view", HTMLElement).addEventListener("pointerdown", () => {
      if (this.narrow.matches) this.setOpen(false);
    });
  }

  get isOpen(): boolean {
    return !this.panel.classList.contains("closed");
  }

  setOpen(open: boolean): void {
    this.panel.classList.toggle("closed", !open);
    this.button.setAttribute("aria-expanded", String(open));
    this.button.setAttribute("aria-pressed", String(open));
    this.listener.menuCovers(open && !this.narrow.matches ? this.panel.offsetWidth : 0);
  }

  /** Opens the menu for a gamepad; where it covers nothing it stays open afterwards. */
  showByPad(open: boolean): void {
    if (open || this.narrow.matches) this.setOpen(open);
  }

  showCatalog(catalog: Catalog): void {
    this.offered = catalog.scenes.map(({ name }) => name);
    this.courses.showCatalog(catalog);
    setOptions(this.scene, catalog.scenes.map((s) => [s.name, sceneTitle(s.title)]));
    setOptions(this.avatar, catalog.avatars.map((a) => [a.id, worded(a.title)]));
    this.clips.add(catalog.clips);
    setOptions(this.planner, catalog.planners.map((name) => [name, name]));
    this.queue.min = String(Math.min(...catalog.queueSizes));
    this.queue.max = String(Math.max(...catalog.queueSizes));
    setOptions(this.style, catalog.styles.map(({ name }) => [name, worded(name)]));
    this.liked = new Map(catalog.styles.map(({ name, speed }) => [name, speed]));
    const [slowest, fastest] = catalog.walkSpeed;
    Object.assign(this.speed, { min: String(slowest), max: String(fastest), step: "0.05" });
  }

  showSettings(settings: Settings): void {
    this.courses.showScene(settings.scene);
    this.scene.value = settings.scene;
    this.avatar.value = settings.avatar;
    this.planner.value = settings.planner;
    showValue(this.queue, String(settings.queueSize));
    showValue(this.speed, String(settings.walkSpeed));
    this.style.value = settings.style;
    this.showValues();
    this.clips.showSettings(settings);
    const assist = byId("assist", HTMLButtonElement);
    assist.setAttribute("aria-checked", String(settings.assist));
    const value = assist.querySelector(".value");
    if (value) value.textContent = worded(settings.assist ? "on" : "off");
    const pause = byId("pause", HTMLButtonElement);
    pause.setAttribute("aria-pressed", String(settings.paused));
    pause.setAttribute("aria-label", worded(settings.paused ? "Resume" : "Pause"));
    for (const slow of document.querySelectorAll("[data-action=slow]")) {
      slow.setAttribute("aria-pressed", String(settings.speed < 1));
    }
  }

  /** Adds a scene that the list does not offer: a course by its seed. */
  addScene(name: string, title: string): void {
    if ([...this.scene.options].some((option) => option.value === name)) return;
    this.scene.querySelector("[data-passing]")?.remove();
    const option = new Option(title, name);
    option.dataset["passing"] = "";
    this.scene.add(option);
    this.scene.value = name;
  }

  /** Whether there is a button for a guided tour. */
  offerTour(offered: boolean): void {
    byId("tour", HTMLButtonElement).hidden = !offered;
  }

  /** Adds an avatar that came as a file, unless the list has it. */
  addAvatar(id: string, title: string): void {
    if ([...this.avatar.options].some((option) => option.value === id)) return;
    this.avatar.add(new Option(worded(title), id));
  }

  showOverlays(shown: ReadonlySet<OverlayName>): void {
    for (const [name, box] of this.checks) box.checked = shown.has(name);
  }

  /** Which of the panels over the picture are shown. */
  showPanels({ hud, inset }: Preferences): void {
    this.hud.checked = hud;
    this.inset.checked = inset;
  }

  showView(shown: ViewName): void {
    for (const name of VIEW_NAMES) {
      byId("views", HTMLElement).querySelector(`[data-action="view:${name}"]`)?.setAttribute("aria-pressed", String(name === shown));
    }
  }

  showPreference(name: "steering" | "quality" | "theme", value: string): void {
    byId(name, HTMLSelectElement).value = value;
  }

  private listenToLists(): void {
    for (const name of ["scene", "avatar", "planner"] as const) {
      this[name].addEventListener("change", () => this.listener.configure({ [name]: this[name].value }));
    }
  }

  /** A style comes at the speed that it likes. */
  private listenToStyle(): void {
    this.style.addEventListener("change", () => {
      const style = this.style.value;
      this.listener.configure({ style, walkSpeed: this.liked.get(style) ?? null });
    });
  }

  private listenToSliders(): void {
    for (const slider of [this.queue, this.speed]) slider.addEventListener("input", () => this.showValues());
    this.queue.addEventListener("change", () => this.listener.configure({ queueSize: Number(this.queue.value) }));
    this.speed.addEventListener("change", () => this.listener.configure({ walkSpeed: Number(this.speed.value) }));
  }

  private showValues(): void {
    byId("queue-value", HTMLOutputElement).value = this.queue.value;
    byId("speed-value", HTMLOutputElement).value = `${Number(this.speed.value).toFixed(2)} m/s`;
  }

  private listenToFile(): void {
    byId("open-file", HTMLButtonElement).addEventListener("click", () => this.file.click());
    this.file.addEventListener("change", () => {
      this.listener.files([...(this.file.files ?? [])]);
      this.file.value = "";
    });
  }

  private addViews(): void {
    const host = byId("views", HTMLElement);
    VIEW_NAMES.forEach((name, i) => {
      const button = make("button", { class: "plain", type: "button", title: `${worded(VIEWS[name].title)} (${i + 1})` }, worded(VIEWS[name].title));
      button.dataset["action"] = `view:${name}`;
      host.append(button);
    });
  }

  private listenToButtons(): void {
    for (const button of document.querySelectorAll<HTMLButtonElement>("button[data-action]")) {
      button.addEventListener("click", () => this.listener.action(button.dataset["action"] as Action));
    }
    byId("hud-close", HTMLButtonElement).addEventListener("click", () => this.listener.prefer({ hud: false }));
    this.button.addEventListener("click", () => this.setOpen(!this.isOpen));
  }

  private addOverlays(): void {
    const host = byId("overlays", HTMLElement);
    for (const name of OVERLAYS) {
      const box = make("input", { type: "checkbox", id: `overlay-${name}` });
      box.addEventListener("change", () => this.listener.overlay(name, box.checked));
      this.checks.set(name, box);
      host.append(make("label", {}, box, worded(OVERLAY_TITLES[name]), make("span", { class: `key key-${name}`, "aria-hidden": "true" })));
    }
  }

  private bindPreferences(preferences: Preferences): void {
    for (const name of ["steering", "quality", "theme"] as const) {
      const select = byId(name, HTMLSelectElement);
      select.value = preferences[name];
      select.addEventListener("change", () => this.listener.prefer({ [name]: select.value }));
    }
    const language = byId("language", HTMLSelectElement);
    language.value = preferences.language;
    language.addEventListener("change", () => this.listener.prefer({ language: language.value as Preferences["language"] }));
    this.hud.addEventListener("change", () => this.listener.prefer({ hud: this.hud.checked }));
    this.inset.addEventListener("change", () => this.listener.prefer({ inset: this.inset.checked }));
    this.sound.checked = preferences.sound;
    this.sound.addEventListener("change", () => this.listener.prefer({ sound: this.sound.checked }));
    this.showPanels(preferences);
    this.showOverlays(preferences.overlays);
  }
}
