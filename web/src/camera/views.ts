/** The cameras that follow the avatar: where each looks from, as numbers. */

/** Where a camera looks from. Radians and metres. */
export interface View {
  readonly title: string;
  /**
   * Where it looks, against the avatar's heading: 0 from behind, a quarter turn from its right side. `null` for a
   * camera whose direction is the user's own and not the avatar's.
   */
  readonly bearing: number | null;
  /** Above the horizon. */
  readonly pitch: number;
  readonly distance: number;
  /** Height of the point that it looks at, as a share of the eyes' height. */
  readonly height: number;
  /** That point lies so far to the right of the avatar. */
  readonly aside: number;
  /** The picture is shifted up by this share of its height, so that the feet stand clear of its lower edge. */
  readonly lift: number;
  /** How long half of a turn of the avatar takes the camera along, seconds. */
  readonly halflife: number;
}

export const VIEW_NAMES = ["behind", "side", "front", "above", "orbit", "shoulder"] as const;

export type ViewName = (typeof VIEW_NAMES)[number];

const FOLLOWS = { height: 1, aside: 0, lift: 0.08, halflife: 0.3 } as const;

export const VIEWS: Readonly<Record<ViewName, View>> = {
  behind: { ...FOLLOWS, title: "Behind", bearing: null, pitch: 0.24, distance: 3.9 },
  side: { ...FOLLOWS, title: "Side", bearing: Math.PI / 2, pitch: 0.1, distance: 3.6, height: 0.72, lift: 0.02, halflife: 0.5 },
  front: { ...FOLLOWS, title: "Front", bearing: Math.PI, pitch: 0.12, distance: 3.4, height: 0.8, lift: 0.03, halflife: 0.5 },
  above: { ...FOLLOWS, title: "Above", bearing: 0, pitch: 1.45, distance: 6, lift: 0, halflife: 0.5 },
  orbit: { ...FOLLOWS, title: "Orbit", bearing: null, pitch: 0.24, distance: 4.2, height: 0.72, lift: 0.02 },
  shoulder: { ...FOLLOWS, title: "Shoulder", bearing: 0, pitch: 0.14, distance: 1.7, height: 1.02, aside: 0.42, lift: 0, halflife: 0.16 },
};

/** The view of this name; the one from behind if there is none. */
export function viewNamed(name: string | null): ViewName {
  return VIEW_NAMES.find((known) => known === name) ?? "behind";
}

/** The view after this one, round and round. */
export function nextView(name: ViewName): ViewName {
  return VIEW_NAMES[(VIEW_NAMES.indexOf(name) + 1) % VIEW_NAMES.length] as ViewName;
}
