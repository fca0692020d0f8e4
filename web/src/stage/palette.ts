/** The colours of the 3D world, light and dark; the page's own colours live in style.css. */

export type Theme = "light" | "dark";

export interface Palette {
  readonly skyTop: number;
  readonly horizon: number;
  readonly skyGround: number;
  /** Far hills along the horizon. */
  readonly hills: number;
  /** The open field round a scene, in two tones that change every few metres. */
  readonly field: readonly [string, string];
  readonly slab: string;
  readonly gridFine: string;
  readonly gridBold: string;
  readonly contact: string;
  /** What the lights make of a white floor that nothing shades. */
  readonly floorLight: number;
  readonly keyLight: number;
  readonly keyIntensity: number;
  readonly skyLight: number;
  readonly groundLight: number;
  readonly ambientIntensity: number;
  readonly environmentIntensity: number;
  readonly exposure: number;
  readonly obstacles: readonly number[];
  readonly accent: number;
  /** The finish: light and dark. */
  readonly banner: readonly [string, string];
  readonly path: number;
  readonly ghost: number;
  readonly goal: number;
  readonly chosen: number;
  readonly capsule: number;
  readonly touching: number;
  readonly nearest: number;
}

/** Colour-blind-safe accents (after Okabe and Ito): teal, orange, sky blue, vermilion differ in lightness as well. */
export const PALETTES: Readonly<Record<Theme, Palette>> = {
  light: {
    skyTop: 0x9db9c7,
    horizon: 0xe9e7e0,
    skyGround: 0xd8d5cc,
    hills: 0xb3bdb8,
    field: ["#dcd8ce", "#d3cfc3"],
    slab: "#f2efe8",
    gridFine: "rgba(80, 72, 58, 0.13)",
    gridBold: "rgba(80, 72, 58, 0.26)",
    contact: "#3a3026",
    floorLight: 0xfaf6ee,
    keyLight: 0xfff0dd,
    keyIntensity: 2.15,
    skyLight: 0xdde8f2,
    groundLight: 0xb9ad98,
    ambientIntensity: 0.95,
    environmentIntensity: 0.32,
    exposure: 1.0,
    obstacles: [0xc98a72, 0xd9b978, 0x8fa893, 0x7f97ab, 0xa88da2, 0xb99f8c],
    accent: 0x17756c,
    banner: ["#fbf9f4", "#23302e"],
    path: 0x17756c,
    ghost: 0x2c6f93,
    goal: 0xc98a12,
    chosen: 0x17756c,
    capsule: 0x2f7fb0,
    touching: 0xd23b2a,
    nearest: 0xb2441e,
  },
  dark: {
    skyTop: 0x0d141f,
    horizon: 0x2a3546,
    skyGround: 0x1b222d,
    hills: 0x1f2836,
    field: ["#272e38", "#2c343f"],
    slab: "#3a424e",
    gridFine: "rgba(190, 210, 235, 0.055)",
    gridBold: "rgba(190, 210, 235, 0.13)",
    contact: "#04060a",
    floorLight: 0xdfe0e4,
    keyLight: 0xffe3c0,
    keyIntensity: 2.0,
    skyLight: 0xb2c0d6,
    groundLight: 0x3a3531,
    ambientIntensity: 1.0,
    environmentIntensity: 0.28,
    exposure: 1.0,
    obstacles: [0xb27460, 0xbd9a5a, 0x78917f, 0x66809a, 0x8d7489, 0x9c7f6c],
    accent: 0x4fc7b8,
    banner: ["#e3e9ee", "#18211f"],
    path: 0x4fc7b8,
    ghost: 0x6fb5df,
    goal: 0xf0b64a,
    chosen: 0x4fc7b8,
    capsule: 0x66b6e6,
    touching: 0xff5a43,
    nearest: 0xff9062,
  },
};
