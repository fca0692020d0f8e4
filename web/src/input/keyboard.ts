/** The keyboard, by `event.code`, so that the keys lie in the same place on every layout. */

import type { Intent } from "./steering";

/** Something that one key press does once. */
export type Action =
  | "reset" | "pause" | "step" | "slow" | "cameraMode" | "overlays" | "hideUi" | "assist" | "help" | "recenter"
  | "pointerLock" | "escape" | "menu";

const ACTIONS: Readonly<Record<string, Action>> = {
  KeyR: "reset", KeyP: "pause", Space: "pause", Period: "step", KeyM: "slow", KeyV: "cameraMode", KeyO: "overlays",
  KeyH: "hideUi", KeyT: "assist", F1: "help", KeyC: "recenter", KeyL: "pointerLock", Escape: "escape", KeyN: "menu",
};

const HELD = new Set([
  "KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE", "ArrowUp", "ArrowLeft", "ArrowDown", "ArrowRight", "ShiftLeft",
  "ShiftRight",
]);

export class Keyboard {
  private readonly held = new Set<string>();

  constructor(private readonly onAction: (action: Action) => void, private readonly onChange: () => void) {
    window.addEventListener("keydown", (event) => this.down(event));
    window.addEventListener("keyup", (event) => this.up(event));
    window.addEventListener("blur", () => this.releaseAll());
    document.addEventListener("visibilitychange", () => this.releaseAll());
    document.addEventListener("focusin", (event) => {
      if (takesKey(event.target, "")) this.releaseAll();
    });
  }

  /** How many steering keys are down. */
  get heldCount(): number {
    return this.held.size;
  }

  get intent(): Intent {
    const on = (...codes: string[]) => (codes.some((code) => this.held.has(code)) ? 1 : 0);
    return {
      forward: on("KeyW", "ArrowUp") - on("KeyS", "ArrowDown"),
      right: on("KeyD", "ArrowRight") - on("KeyA", "ArrowLeft"),
      strafe: on("KeyQ") - on("KeyE"),
      run: on("ShiftLeft", "ShiftRight") === 1,
    };
  }

  releaseAll(): void {
    if (this.held.size === 0) return;
    this.held.clear();
    this.onChange();
  }

  private down(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const action = event.key === "?" ? "help" : ACTIONS[event.code];
    if (takesKey(event.target, event.code) && event.code !== "Escape" && event.code !== "F1") return;
    if (HELD.has(event.code)) {
      event.preventDefault();
      if (!this.held.has(event.code)) {
        this.held.add(event.code);
        this.onChange();
      }
      return;
    }
    if (!action || (event.code === "Space" && pressesByKey(event.target))) return;
    if (action !== "escape") event.preventDefault();
    if (!event.repeat || action === "step") this.onAction(action);
  }

  private up(event: KeyboardEvent): void {
    if (this.held.delete(event.code)) this.onChange();
  }
}

/** Whether a key belongs to the element: text fields and lists use all keys themselves, sliders the arrows. */
function takesKey(target: EventTarget | null, code: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  if (!(target instanceof HTMLInputElement)) return false;
  if (target.type === "range") return code.startsWith("Arrow");
  return target.type !== "checkbox" && target.type !== "button";
}

/** Whether the space bar presses the element. */
function pressesByKey(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && (target.closest("button, a, summary, input") !== null);
}
