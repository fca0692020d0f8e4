/** The keyboard, by `event.code`, so that the keys lie in the same place on every layout. */

import type { Action } from "./action";
import { HELD_DEEDS, type HeldDeed, type KeyMap } from "./key_map";
import type { Intent } from "./steering";

/** Keys by which lists and sliders are worked; all others steer past them. */
const CONTROL_KEYS = /^(Arrow.*|Home|End|PageUp|PageDown|Enter|NumpadEnter|Space)$/;

export class Keyboard {
  /** What the keys that are down do, by their codes. */
  private readonly held = new Map<string, HeldDeed>();

  constructor(private readonly keys: KeyMap, private readonly onAction: (action: Action) => void, private readonly onChange: () => void) {
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
    const down = new Set(this.held.values());
    const on = (deed: HeldDeed) => Number(down.has(deed));
    return {
      forward: on("forward") - on("back"),
      right: on("right") - on("left"),
      strafe: on("stepLeft") - on("stepRight"),
      run: down.has("run"),
    };
  }

  releaseAll(): void {
    if (this.held.size === 0) return;
    this.held.clear();
    this.onChange();
  }

  private down(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const deed = event.key === "?" ? "help" : this.keys.deedOf(event.code);
    const { activeElement } = document;
    const always = event.code === "Escape" || event.code === "F1" || (deed === "help" && !takesText(activeElement));
    if (!always && takesKey(activeElement, event.code)) return;
    if (!deed) return;
    if (isHeld(deed)) {
      event.preventDefault();
      if (!this.held.has(event.code)) {
        this.held.set(event.code, deed);
        this.onChange();
      }
      return;
    }
    if (deed !== "escape") event.preventDefault();
    if (!event.repeat || deed === "step" || deed === "stepBack") this.onAction(deed);
  }

  private up(event: KeyboardEvent): void {
    if (this.held.delete(event.code)) this.onChange();
  }
}

function isHeld(deed: HeldDeed | Action): deed is HeldDeed {
  return (HELD_DEEDS as readonly string[]).includes(deed);
}

/** Whether a key belongs to the element that has the focus: letters steer on past lists, sliders and buttons. */
function takesKey(focused: Element | null, code: string): boolean {
  if (takesText(focused) || focused?.closest("dialog[open]")) return true;
  if (focused instanceof HTMLSelectElement) return isOpen(focused) || CONTROL_KEYS.test(code);
  if (focused instanceof HTMLInputElement && (focused.type === "range" || focused.type === "radio")) return CONTROL_KEYS.test(code);
  return (code === "Space" || code === "Enter") && (focused?.closest("button, a, summary, input") ?? null) !== null;
}

/** Whether one writes in an element. */
export function takesText(target: EventTarget | null): boolean {
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
