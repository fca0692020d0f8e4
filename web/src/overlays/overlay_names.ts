/** The overlays that can be switched on. */

export const OVERLAYS = ["capsules", "path", "ghosts", "goal", "nearest", "plan", "footprints"] as const;

export type OverlayName = (typeof OVERLAYS)[number];

export const OVERLAY_TITLES: Readonly<Record<OverlayName, string>> = {
  capsules: "Collision body",
  path: "Root path",
  ghosts: "Planned key frames",
  goal: "Wanted and chosen posture",
  nearest: "Nearest distance",
  plan: "Plan status",
  footprints: "Footprints",
};

/** Reads `capsules,path` or `all`; unknown names are ignored. */
export function parseOverlays(text: string | null): Set<OverlayName> {
  if (!text) return new Set();
  if (text === "all") return new Set(OVERLAYS);
  const wanted = text.split(",");
  return new Set(OVERLAYS.filter((name) => wanted.includes(name)));
}
