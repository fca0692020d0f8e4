/** Which key does what: as it comes, and as the user has changed it. By `event.code`, so that keys lie where they lie on every layout. */

import { VIEW_NAMES } from "../camera/views";
import type { Action } from "./action";

/** What a key does for as long as it is held. */
export const HELD_DEEDS = ["forward", "back", "left", "right", "stepLeft", "stepRight", "run"] as const;
export type HeldDeed = (typeof HELD_DEEDS)[number];

/** What keys can be given to. */
export type KeyDeed = HeldDeed | Action;

/** The keys that can be changed. */
const CHANGEABLE: readonly (readonly [string, KeyDeed])[] = [
  ["KeyW", "forward"], ["KeyS", "back"], ["KeyA", "left"], ["KeyD", "right"], ["KeyQ", "stepLeft"], ["KeyE", "stepRight"],
  ["ShiftLeft", "run"], ["KeyR", "reset"], ["KeyP", "pause"], ["Period", "step"], ["KeyM", "slow"], ["Comma", "stepBack"],
  ["KeyV", "cameraMode"], ["KeyO", "overlays"], ["KeyH", "hideUi"], ["KeyT", "assist"], ["KeyC", "recenter"],
  ["KeyL", "pointerLock"], ["KeyN", "menu"], ["KeyB", "nextView"], ["KeyI", "inset"], ["KeyK", "replay"], ["KeyU", "build"],
  ["KeyG", "push"], ["Equal", "nearer"], ["Minus", "farther"],
  ...VIEW_NAMES.map((name, i) => [`Digit${i + 1}`, `view:${name}`] as const),
];

/** Those that stay. */
const FIXED: readonly (readonly [string, KeyDeed])[] = [
  ["ArrowUp", "forward"], ["ArrowDown", "back"], ["ArrowLeft", "left"], ["ArrowRight", "right"], ["ShiftRight", "run"],
  ["Space", "pause"], ["F1", "help"], ["Escape", "escape"],
];
/** Keys that pages and browsers need themselves. */
const NEVER = /^(Tab|Enter|NumpadEnter|Control|Alt|Meta|F\d|OS|ContextMenu|CapsLock|Backspace|Delete|PrintScreen)/;

const STORE = "elbowroom.keys";

/** The keys as they come, by code. */
export const DEFAULT_KEYS: ReadonlyMap<string, KeyDeed> = new Map([...CHANGEABLE, ...FIXED]);

export class KeyMap {
  private readonly codes: Map<KeyDeed, string>;

  /** @param store keeps what is changed; without one it holds until the page is left */
  constructor(private readonly store: Storage | null) {
    this.codes = new Map(CHANGEABLE.map(([code, deed]) => [deed, code]));
    for (const [deed, code] of stored(store)) if (this.codes.has(deed) && mayBe(code)) this.codes.set(deed, code);
    if (new Set(this.codes.values()).size < this.codes.size) this.codes = defaults();
  }

  /** The deeds whose keys can be changed. */
  get deeds(): readonly KeyDeed[] {
    return [...this.codes.keys()];
  }

  /** What a key does; nothing where it is `undefined`. */
  deedOf(code: string): KeyDeed | undefined {
    for (const [deed, own] of this.codes) if (own === code) return deed;
    return FIXED.find(([fixed]) => fixed === code)?.[1];
  }

  /** The key of a deed that can be changed. */
  codeOf(deed: KeyDeed): string {
    return this.codes.get(deed) ?? "";
  }

  /** Gives a deed another key; what had that key gets the deed's old one. False for a key that cannot be given. */
  give(deed: KeyDeed, code: string): boolean {
    const old = this.codes.get(deed);
    if (old === undefined || !mayBe(code)) return false;
    const other = this.deeds.find((one) => this.codes.get(one) === code);
    if (other) this.codes.set(other, old);
    this.codes.set(deed, code);
    this.keep();
    return true;
  }

  /** All keys as they came. */
  reset(): void {
    for (const [deed, code] of defaults()) this.codes.set(deed, code);
    this.keep();
  }

  /** How a key that came as `cap` is called now: "W" while forward is W. */
  capNow(cap: string): string {
    const found = CHANGEABLE.find(([code]) => capOf(code) === cap);
    return found ? capOf(this.codeOf(found[1])) : cap;
  }

  private keep(): void {
    try {
      this.store?.setItem(STORE, JSON.stringify(Object.fromEntries(this.codes)));
    } catch {
      return; // a browser that stores nothing
    }
  }
}

/** How a key is called. */
export function capOf(code: string): string {
  const names: Readonly<Record<string, string>> = {
    Period: ".", Comma: ",", Semicolon: ";", Quote: "'", Slash: "/", Backslash: "\\", BracketLeft: "[", BracketRight: "]", Minus: "-", Equal: "=",
    Backquote: "`", ShiftLeft: "Shift", ShiftRight: "Shift",
  };
  return names[code] ?? code.replace(/^(Key|Digit)/, "").replace(/^Numpad/, "Num ");
}

function mayBe(code: string): boolean {
  return code !== "" && code.length < 20 && !NEVER.test(code) && !FIXED.some(([fixed]) => fixed === code);
}

function defaults(): Map<KeyDeed, string> {
  return new Map(CHANGEABLE.map(([code, deed]) => [deed, code]));
}

function stored(store: Storage | null): [KeyDeed, string][] {
  try {
    const kept: unknown = JSON.parse(store?.getItem(STORE) ?? "{}");
    if (typeof kept !== "object" || kept === null) return [];
    return Object.entries(kept).filter((entry): entry is [KeyDeed, string] => typeof entry[1] === "string");
  } catch {
    return [];
  }
}
