/** What the help says: one table for each device, the one at hand first. */

import { VIEW_NAMES, VIEWS } from "../camera/views";
import { PAD_BUTTONS, type PadDeed } from "../input/gamepad";

export type Row = readonly [keys: readonly string[], meaning: string];

/** Some rows under a title. */
export interface Section {
  readonly title: string;
  readonly rows: readonly Row[];
}

/** What there is to steer with, besides a keyboard. */
export interface Devices {
  readonly touch: boolean;
  readonly gamepad: boolean;
}

const KEYBOARD: readonly Section[] = [
  { title: "Walk", rows: [
    [["W", "A", "S", "D"], "or the arrow keys: walk where the camera looks"],
    [["S"], "back up, facing the same way"],
    [["Q", "E"], "step to the left and right"],
    [["Shift"], "run"],
    [["click"], "on the floor: go there; any key takes over"],
    [["drag"], "a thing: push it over the floor; the avatar makes way"],
    [["G"], "take a thing in hand, again the next; arrow keys push it, Esc lets go"],
    [["R"], "back to the start"],
  ] },
  { title: "Look", rows: [
    [["drag"], "look around; the wheel or a pinch zooms"],
    [VIEW_NAMES.map((_, i) => String(i + 1)), `camera: ${VIEW_NAMES.map((name) => VIEWS[name].title.toLowerCase()).join(", ")}`],
    [["B"], "next camera; in all but the first, W walks the way the avatar faces"],
    [["=", "-"], "camera nearer, farther"],
    [["I"], "side view in the corner"],
    [["C"], "bring the camera back to its place"],
    [["L"], "lock the pointer to the view, Esc frees it"],
    [["V"], "steer relative to the camera or to the body"],
  ] },
  { title: "Time", rows: [
    [["P"], "or Space: pause"],
    [["."], "one step of 1/60 s"],
    [["M"], "slow motion"],
    [["K"], "replay of the last walk; in it Space plays, R begins anew, Esc closes"],
    [[","], "one step back in a replay"],
  ] },
  { title: "See", rows: [
    [["T"], "assist on and off: planned motion or the canned walk"],
    [["O"], "overlays"],
    [["N"], "menu"],
    [["U"], "build mode: place and move things, try them, send them as a file or an address"],
    [["H"], "hide everything but the world; Esc shows it again"],
    [["?"], "or F1: this help"],
  ] },
];

const PAD_MEANINGS: Readonly<Partial<Record<PadDeed, string>>> = {
  run: "run, while it is held",
  stepLeft: "step to the left",
  stepRight: "step to the right",
  nextView: "next camera",
  inset: "side view in the corner",
  recenter: "press the right stick: camera back to its place",
  assist: "assist on and off",
  cameraMode: "steer relative to the camera or to the body",
  reset: "back to the start",
  pause: "press the left stick: pause",
  menu: "menu, card, replay: the cross goes through them, A presses, B goes back",
  slow: "slow motion",
  step: "one step of 1/60 s",
  overlays: "overlays",
  hideUi: "hide everything but the world",
};

const GAMEPAD: Section = { title: "Gamepad", rows: [
  [["left stick"], "walk"],
  [["right stick"], "look around"],
  [["build mode"], "LB and RB go from thing to thing, the cross moves, X turns, Y copies, the triggers scale, the sticks pressed raise and lower, Back deletes"],
  ...Object.entries(PAD_MEANINGS).map(([deed, meaning]): Row => [
    PAD_BUTTONS.filter((button) => button.deed === deed).map(({ name }) => name), meaning,
  ]),
] };

const TOUCH: Section = { title: "Touch", rows: [
  [["left half"], "put a finger down and drag: the stick; push far out to run"],
  [["right half"], "drag to look, or a thing to push it; two fingers zoom"],
  [["tap"], "on the floor: go there"],
  [["☰"], "everything else: time, overlays, measurements, hiding the panels"],
] };

/** All sections, those of the device at hand first. */
export function helpSections({ touch, gamepad }: Devices): readonly Section[] {
  const first = [...(touch ? [TOUCH] : []), ...(gamepad ? [GAMEPAD] : [])];
  const last = [GAMEPAD, TOUCH].filter((section) => !first.includes(section));
  return [...first, ...KEYBOARD, ...last];
}
