/** What the address line and earlier visits ask for. */

import { viewNamed, type ViewName } from "./camera/views";
import type { SteeringMode } from "./input/steering";
import { OVERLAYS, parseOverlays, type OverlayName } from "./overlays/overlay_names";
import type { QualityName } from "./stage/quality";
import { languageOf, LANGUAGES, type Language } from "./texts/language";

export type ThemeChoice = "auto" | "light" | "dark";

/** The page's own choices; the server knows nothing of them. */
export interface Preferences {
  theme: ThemeChoice;
  language: Language | "auto";
  quality: QualityName;
  steering: SteeringMode;
  overlays: Set<OverlayName>;
  /** Whether the measurements are shown. */
  hud: boolean;
  /** Whether the side view is shown in a corner. */
  inset: boolean;
  /** Whether steps are heard. */
  sound: boolean;
}

/** Wishes from the address line, for the start and for the way back to it; null where the line says nothing. */
export interface SessionWishes {
  readonly scene: string | null;
  readonly avatar: string | null;
  readonly planner: string | null;
  readonly queueSize: number | null;
  readonly assist: boolean | null;
  readonly walkSpeed: number | null;
  readonly style: string | null;
  readonly camera: ViewName;
  readonly showUi: boolean;
}

/** Characters of a wish that are told back. */
const LONGEST_TOLD = 40;
const STORE = "elbowroom.preferences";
const QUALITIES: readonly QualityName[] = ["low", "medium", "high", "auto"];
const THEMES: readonly ThemeChoice[] = ["auto", "light", "dark"];
const STEERINGS: readonly SteeringMode[] = ["camera", "tank"];

/** The address line wins over what was stored. */
export function readPreferences(query: URLSearchParams): Preferences {
  const stored = readStore();
  const pick = <T extends string>(name: string, allowed: readonly T[], fallback: T): T =>
    allowed.find((value) => value === query.get(name)) ?? allowed.find((value) => value === stored[name]) ?? fallback;
  const overlays = query.has("overlays") ? query.get("overlays") : stored["overlays"];
  return {
    theme: pick("theme", THEMES, "auto"),
    language: LANGUAGES.find((language) => language === stored["language"]) ?? "auto",
    quality: pick("quality", QUALITIES, "auto"),
    steering: pick("steering", STEERINGS, "camera"),
    overlays: typeof overlays === "string" ? parseOverlays(overlays) : new Set(),
    hud: stored["hud"] !== false,
    inset: stored["inset"] === true,
    sound: stored["sound"] === true,
  };
}

/** Keeps the choices for the next visit; a browser that forbids it is no error. */
export function storePreferences(preferences: Preferences): void {
  const overlays = OVERLAYS.filter((name) => preferences.overlays.has(name)).join();
  try {
    localStorage.setItem(STORE, JSON.stringify({ ...preferences, overlays }));
  } catch {
    return;
  }
}

/** The languages that are wished for, the first wish first. */
export function readLanguages(query: URLSearchParams): readonly (string | null)[] {
  const { language } = readPreferences(query);
  return [query.get("lang"), language === "auto" ? null : language, ...navigator.languages];
}

/** The page's address when it is loaded again in the language that was chosen: what the address says of it goes. */
export function addressWithoutLanguage(address: string): string {
  const url = new URL(address);
  url.searchParams.delete("lang");
  return url.href.replaceAll("%3A", ":").replaceAll("%2C", ",");
}

export function readWishes(query: URLSearchParams): SessionWishes {
  const queue = numberIn(query, "queue");
  const speed = numberIn(query, "speed");
  const assist = query.get("assist");
  return {
    scene: query.get("scene"),
    avatar: query.get("avatar"),
    planner: query.get("planner"),
    queueSize: Number.isInteger(queue) ? queue : null,
    walkSpeed: Number.isFinite(speed) ? speed : null,
    style: query.get("style"),
    camera: viewNamed(query.get("camera")),
    assist: assist === null ? null : assist !== "0" && assist !== "off",
    showUi: query.get("ui") !== "0",
  };
}

/** What the address asks for that the page does not know, as it stands there: what the server knows, it checks itself. */
export function oddities(query: URLSearchParams): readonly string[] {
  const known: Readonly<Record<string, (value: string) => boolean>> = {
    camera: (value) => viewNamed(value) === value,
    speed: () => Number.isFinite(numberIn(query, "speed")),
    queue: () => Number.isInteger(numberIn(query, "queue")),
    overlays: (value) => ["all", "none", ""].includes(value) || value.split(",").every((name) => OVERLAYS.some((one) => one === name)),
    quality: (value) => QUALITIES.some((one) => one === value),
    theme: (value) => THEMES.some((one) => one === value),
    lang: (value) => languageOf(value) !== null,
  };
  return Object.entries(known).flatMap(([name, knows]) => {
    const value = query.get(name);
    return value === null || knows(value) ? [] : [`${name}=${value.slice(0, LONGEST_TOLD)}`];
  });
}

/** NaN where there is none. */
function numberIn(query: URLSearchParams, name: string): number {
  return Number(query.get(name)?.trim() || NaN);
}

function readStore(): Record<string, unknown> {
  try {
    const data: unknown = JSON.parse(localStorage.getItem(STORE) ?? "{}");
    return typeof data === "object" && data !== null ? (data as Record<string, unknown>) : {};
  } catch {
    return {};
  }
}
