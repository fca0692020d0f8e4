/** The keyboard, by `event.code`, so that the keys lie in the same place on every layout. */

import { VIEW_NAMES, type ViewName } from "../camera/views";
import type { Intent } from "./steering";

/** Something that one key press does once. */
export type Action =
  | "reset" | "pause" | "step" | "slow" | "cameraMode" | "overlays" | "hideUi" | "assist" | "help" | "recenter"
  | "pointerLock" | "escape" | "menu" | "nextView" | "inset" | "share" | "stepBack" | "replay" | "build" | `view:${ViewName}`;

/** What each key does, by `event.code`. */
export const KEY_ACTIONS: Readonly<Record<string, Action>> = {
  KeyR: "reset", KeyP: "pause", Space: "pause", Period: "step", KeyM: "slow", KeyV: "cameraMode", KeyO: "overlays",
  KeyH: "hideUi", KeyT: "assist", F1: "help", KeyC: "recenter", KeyL: "pointerLock", Escape: "escape", KeyN: "menu",
  KeyB: "nextView", KeyI: "inset", KeyK: "replay", KeyU: "build", Comma: "stepBack", ...Object.fromEntries(VIEW_NAMES.map((name, i) => [`Digit${i + 1}`, `view:${name}` as const])),
};

/** Keys that steer while they are held. */
export const HELD_KEYS: ReadonlySet<string> = new Set([
  "KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE", "ArrowUp", "ArrowLeft", "ArrowDown", "ArrowRight", "ShiftLeft",
  "ShiftRight",
]);

/** Keys by which lists and sliders are worked; all others steer past them. */
const CONTROL_KEYS = /^(Arrow.*|Home|End|PageUp|PageDown|Enter|NumpadEnter|Space)$/;

export class Keyboard {
  private readonly held = new Set<string>();

  constructor(private readonly onAction: (action: Action) => void, private readonly onChange: () => void) {
    window.addEventListener("keydown", (event) => this.down(event));
    window.addEventListener("keyup", (event) => this.up(event));
    window.addEventListener("blur", () => this.releaseAll());
    document.addEventListener("visibilitychange", () => this.releaseAll());
    // What opens a list or takes text may swallow the key's release.
    document.addEventListener("focusin", ({ target }) => {
      if (target instanceof HTMLSelectElement || takesText(target)) this.releaseAll();
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
    const action = event.key === "?" ? "help" : KEY_ACTIONS[event.code];
    const { activeElement } = document;
    const always = event.code === "Escape" || event.code === "F1" || (action === "help" && !takesText(activeElement));
    if (!always && takesKey(activeElement, event.code)) return;
    if (HELD_KEYS.has(event.code)) {
      event.preventDefault();
      if (!this.held.has(event.code)) {
        this.held.add(event.code);
        this.onChange();
      }
      return;
    }
    if (!action) return;
    if (action !== "escape") event.preventDefault();
    if (!event.repeat || action === "step" || action === "stepBack") this.onAction(action);
  }

  private up(event: KeyboardEvent): void {
    if (this.held.delete(event.code)) this.onChange();
  }
}

/** Whether a key belongs to the element that has the focus: letters steer on past lists, sliders and buttons. */
function takesKey(focused: Element | null, code: string): boolean {
  if (takesText(focused) || focused?.closest("dialog[open]")) return true;
  if (focused instanceof HTMLSelectElement) return isOpen(focused) || CONTROL_KEYS.test(code);
  if (focused instanceof HTMLInputElement && (focused.type === "range" || focused.type === "radio")) return CONTROL_KEYS.test(code);
  return (code === "Space" || code === "Enter") && (focused?.closest("button, a, summary, input") ?? null) !== null;
}

function takesText(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && !["range", "checkbox", "radio", "button", "file"].includes(target.type);
}

/** Whether the list of a select is open; browsers that cannot tell keep the keys to themselves while it is. */
export function isOpen(select: HTMLSelectElement): boolean {
  try {
    return select.matches(":open");
  } catch {
    return false;
  }
}
