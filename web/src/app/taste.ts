/** What the user prefers, and how the page follows it: panels, camera, steering, overlays, colours. */

import type { ViewName } from "../camera/views";
import type { SteeringMode } from "../input/steering";
import { OVERLAYS, type OverlayName } from "../overlays/overlay_names";
import type { Picture } from "../picture";
import { addressWithoutLanguage, storePreferences, type Preferences } from "../preferences";
import { byId } from "../ui/dom";
import type { Menu } from "../ui/menu";

const DEFAULT_OVERLAYS: readonly OverlayName[] = ["path", "ghosts", "nearest"];

/** What shows what is preferred, and who is told of it. */
export interface TasteHost {
  readonly picture: Picture;
  readonly menu: Menu;
  /** Other overlays are shown. */
  overlaysChanged(): void;
  /** The colours are others. */
  repainted(): void;
}

export class Taste {
  private readonly dark = window.matchMedia("(prefers-color-scheme: dark)");
  private lastOverlays: readonly OverlayName[] = DEFAULT_OVERLAYS;

  constructor(readonly preferences: Preferences, private readonly host: TasteHost) {
    this.applyTheme();
    this.dark.addEventListener("change", () => this.applyTheme());
    this.showPanels();
  }

  prefer(change: Partial<Preferences>): void {
    const { preferences } = this;
    const { menu, picture } = this.host;
    Object.assign(preferences, change);
    for (const name of ["steering", "quality", "theme"] as const) menu.showPreference(name, preferences[name]);
    this.showPanels();
    if (change.theme) this.applyTheme();
    if (change.quality) picture.setQuality(change.quality);
    storePreferences(preferences);
    if (change.language) location.replace(addressWithoutLanguage(location.href));
  }

  /** Whether the side view is shown in the corner now. */
  get insetShown(): boolean {
    return this.preferences.inset && !this.bare;
  }

  /** From behind as the user prefers it; all other cameras show the avatar walk the way it faces. */
  get steering(): SteeringMode {
    return this.host.picture.camera.viewName === "behind" ? this.preferences.steering : "tank";
  }

  toggleSteering(): void {
    this.prefer({ steering: this.preferences.steering === "camera" ? "tank" : "camera" });
  }

  /** Whether all panels are hidden. */
  get bare(): boolean {
    return document.body.classList.contains("bare");
  }

  /** Hides or shows all panels. */
  setBare(bare: boolean): void {
    const { menu } = this.host;
    document.body.classList.toggle("bare", bare);
    menu.setOpen(menu.isOpen);
  }

  showCamera(name: ViewName): void {
    this.host.picture.camera.show(name);
    this.host.menu.showView(name);
  }

  overlay(name: OverlayName, on: boolean): void {
    const { overlays } = this.preferences;
    if (on) overlays.add(name);
    else overlays.delete(name);
    this.overlaysChanged();
  }

  setOverlays(overlays: Set<OverlayName>): void {
    this.preferences.overlays = overlays;
    this.overlaysChanged();
  }

  /** Hides all overlays, or shows those that were hidden last. */
  toggleAllOverlays(): void {
    const { overlays } = this.preferences;
    const shown = OVERLAYS.filter((name) => overlays.has(name));
    if (shown.length > 0) this.lastOverlays = shown;
    overlays.clear();
    if (shown.length === 0) for (const name of this.lastOverlays) overlays.add(name);
    this.overlaysChanged();
  }

  private overlaysChanged(): void {
    this.host.menu.showOverlays(this.preferences.overlays);
    storePreferences(this.preferences);
    this.host.overlaysChanged();
  }

  private showPanels(): void {
    this.host.menu.showPanels(this.preferences);
    byId("hud", HTMLElement).hidden = !this.preferences.hud;
    byId("inset", HTMLElement).hidden = !this.preferences.inset;
  }

  private applyTheme(): void {
    const { theme } = this.preferences;
    const shown = theme === "auto" ? (this.dark.matches ? "dark" : "light") : theme;
    document.documentElement.dataset["theme"] = shown;
    document.querySelector('meta[name="theme-color"]')?.setAttribute("content", shown === "dark" ? "#2a3546" : "#e6e5df");
    this.host.picture.setTheme(shown);
    this.host.repainted();
  }
}
