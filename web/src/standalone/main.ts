/** The player of a page that holds one run: the same picture and the same timeline, without a server. */

import "../style.css";
import "./standalone.css";
import { nextView, VIEW_NAMES } from "../camera/views";
import { POSE_FLAGS } from "../generated/messages";
import { PointerInput } from "../input/pointer";
import { NO_INTENT } from "../input/steering";
import type { ShownPose } from "../net/pose_timeline";
import { Picture } from "../picture";
import { Replay } from "../replay/replay";
import { speak, text } from "../texts/texts";
import { make } from "../ui/dom";
import { readPackedRun } from "./packed_run";
import { sceneTitle } from "../texts/scene_titles";

declare global {
  interface Window {
    elbowroomRun?: ArrayBuffer;
    __player?: unknown;
  }
}

const LONGEST_FRAME = 0.1;
const QUALITY = new URLSearchParams(location.search).get("quality") === "low" ? "low" : "auto";

class StandalonePlayer {
  private readonly view = make("main", { id: "view", tabindex: "-1" });
  private readonly label = make("div", { id: "nearest-label", "aria-hidden": "true" });
  private readonly inset = make("div", { id: "inset", class: "chrome" }, make("span", {}));
  private readonly notices = make("p", { class: "standalone-note", role: "status" });
  private readonly picture: Picture;
  private readonly replay: Replay;
  private readonly dark = window.matchMedia("(prefers-color-scheme: dark)");
  private pose: ShownPose | null = null;
  private last = performance.now() / 1000;
  private drawn = 0;

  constructor(run: ArrayBuffer) {
    const { take } = readPackedRun(run, (file) => URL.createObjectURL(new Blob([file], { type: "model/gltf-binary" })));
    document.body.classList.add("alone");
    this.label.hidden = this.inset.hidden = true;
    this.view.setAttribute("aria-label", sceneTitle(take.scene.title));
    this.view.append(this.label);
    document.body.append(this.view, this.inset, this.heading(sceneTitle(take.scene.title)), this.notices);
    const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
    this.picture = new Picture(this.view, this.label, QUALITY, () => calm.matches);
    this.replay = new Replay({
      picture: this.picture, say: (_, said) => (this.notices.textContent = said), closed: () => undefined,
      dock: (pixels) => document.documentElement.style.setProperty("--dock", `${pixels}px`),
    });
    this.paint();
    this.dark.addEventListener("change", () => this.paint());
    new PointerInput(this.view, this.picture.camera, []);
    window.addEventListener("keydown", (event) => this.key(event));
    this.replay.open([take], take);
    this.expose();
    requestAnimationFrame(() => this.frame());
  }

  private heading(title: string): HTMLElement {
    const camera = make("button", { type: "button", class: "plain" }, text("alone.camera"));
    camera.addEventListener("click", () => this.picture.camera.show(nextView(this.picture.camera.viewName)));
    return make("header", { class: "chrome standalone-head" }, make("h1", {}, title), camera);
  }

  private paint(): void {
    const theme = this.dark.matches ? "dark" : "light";
    document.documentElement.dataset["theme"] = theme;
    this.picture.setTheme(theme);
    this.replay.repaint();
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typed = event.target instanceof HTMLSelectElement || (event.target instanceof HTMLButtonElement && event.code === "Space");
    const view = VIEW_NAMES[Number(/^Digit(\d)$/.exec(event.code)?.[1] ?? 0) - 1];
    if (typed) return;
    if (event.code === "Space") this.replay.toggle();
    else if (event.code === "Period") this.replay.step(1);
    else if (event.code === "Comma") this.replay.step(-1);
    else if (event.code === "KeyC") this.picture.camera.recenter();
    else if (event.code === "KeyB") this.picture.camera.show(nextView(this.picture.camera.viewName));
    else if (view) this.picture.camera.show(view);
    else return;
    event.preventDefault();
  }

  private frame(): void {
    requestAnimationFrame(() => this.frame());
    const now = performance.now() / 1000, elapsed = now - this.last;
    this.last = now;
    this.picture.measure(elapsed);
    const dt = Math.min(elapsed, LONGEST_FRAME);
    this.pose = this.replay.advance(dt) ?? this.pose;
    if (!this.pose) return;
    this.picture.draw(this.pose, {
      status: null, intent: NO_INTENT, steering: "tank", shown: new Set(), inset: false,
      markTouching: (this.pose.flags & POSE_FLAGS.assist) === 0,
    }, dt);
    this.drawn++;
  }

  /** What is shown, for tests and the curious. */
  private expose(): void {
    const { picture, replay } = this;
    Object.defineProperty(window, "__player", { get: () => ({
      replay: replay.state, drawn: this.drawn, avatarLoaded: picture.avatar.loaded, bodyParts: picture.overlays.bodyParts,
      root: this.pose && { x: this.pose.x, z: this.pose.z }, said: this.notices.textContent,
    }) });
  }
}

speak(navigator.languages);
if (window.elbowroomRun) new StandalonePlayer(window.elbowroomRun);
