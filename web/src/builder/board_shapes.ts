/** What lies on the board, as elements: things, tracks, start, finish, handles. Plain data, so that drawing is one loop. */

import { text } from "../texts/texts";
import { shownColour, shownTheme } from "./colours";
import { yawOf } from "./edits";
import type { Editor } from "./editor";
import { onBoard, outline } from "./outline";
import type { Spot, Thing, Vec2, Vec3 } from "./plan";
import { halfSize } from "./shapes";
import { aboutY } from "./turns";

export interface BoardShape {
  /** What it stands for, see `selectedOf`; handles are "turn" and "size". */
  readonly id: string;
  readonly tag: "polygon" | "path" | "circle" | "text";
  readonly attributes: Readonly<Record<string, string>>;
  readonly words?: string;
}

/** CSS pixels. */
const HANDLE = 7;
const STOP = 11;
const SPOT = 0.28;

/** All of it, what lies on top last; `pixel` is how many metres one is, `mark` where the avatar got no further. */
export function shapesOf(editor: Editor, pixel: number, mark: readonly [number, number] | null): readonly BoardShape[] {
  const { plan, side } = editor;
  return [
    ...spots(editor),
    ...plan.things.flatMap((thing, i) => thingShapes(editor, thing, i, pixel)),
    ...stops(editor, pixel),
    ...(mark ? [cross(onBoard(side, [mark[0], 0.1, mark[1]]), 6 * pixel)] : []),
    ...(side === "top" ? handles(editor, pixel) : []),
  ];
}

function spots({ plan: { start, finish }, side, selected }: Editor): BoardShape[] {
  const forward = ({ x, z, heading }: Spot, ahead: number, left: number, up = 0): Vec2 => onBoard(side, [
    x + ahead * Math.sin(heading) + left * Math.cos(heading), up, z + ahead * Math.cos(heading) - left * Math.sin(heading)]);
  const half = finish.width / 2;
  const arrow = [forward(start, 1.6 * SPOT, 0), forward(start, -SPOT, SPOT), forward(start, -0.5 * SPOT, 0), forward(start, -SPOT, -SPOT)];
  const body = side === "side" ? [forward(start, -0.15, 0), forward(start, 0.15, 0), forward(start, 0.15, 0, 1.7), forward(start, -0.15, 0, 1.7)] : arrow;
  const line = side === "top"
    ? `M${forward(finish, 0, half).join(" ")}L${forward(finish, 0, -half).join(" ")}M${forward(finish, 0, 0).join(" ")}L${forward(finish, 0.5, 0).join(" ")}`
    : `M${forward(finish, 0, 0).join(" ")}L${forward(finish, 0, 0, 2).join(" ")}`;
  return [
    { id: "start", tag: "polygon", attributes: { ...worked("start", text("build.start"), selected?.what === "start", start), points: points(body) } },
    { id: "finish", tag: "path", attributes: { ...worked("finish", text("build.finish"), selected?.what === "finish", finish), d: line } },
  ];
}

/** The stops of the tour, numbered, and the way from one to the next. */
function stops({ plan: { tour }, side, selected }: Editor, pixel: number): BoardShape[] {
  const at = tour.map(({ x, z, height }) => onBoard(side, [x, height ?? 0, z]));
  const way: BoardShape[] = at.length > 1
    ? [{ id: "tour", tag: "path", attributes: { class: "tour", d: `M${at.map((place) => place.join(" ")).join("L")}`, "aria-hidden": "true" } }]
    : [];
  return [...way, ...tour.flatMap((stop, i): BoardShape[] => {
    const [u, v] = at[i] ?? [0, 0];
    const pressed = selected?.what === "stop" && selected.index === i;
    const name = text("build.stopAt", i + 1);
    return [
      {
        id: `stop ${i}`, tag: "circle",
        attributes: { ...worked("stop", name, pressed, { center: [stop.x, 0, stop.z] }), cx: String(u), cy: String(v), r: String(STOP * pixel) },
      },
      {
        id: `number ${i}`, tag: "text", words: String(i + 1),
        attributes: { class: "number", x: String(u), y: String(v), "font-size": String(STOP * pixel), "aria-hidden": "true" },
      },
    ];
  })];
}

function thingShapes({ plan, side, selected, index }: Editor, thing: Thing, i: number, pixel: number): BoardShape[] {
  const [first] = thing.track;
  const rotation = first ? aboutY(first.yaw) : thing.rotation;
  const isSelected = index === i;
  const colored = { style: `--own: ${shownColour(plan, i, shownTheme())}` };
  const body: BoardShape = {
    id: `thing ${i}`, tag: "polygon",
    attributes: {
      ...worked(thing.track.length > 0 ? "thing tracked" : "thing", thing.name, isSelected && selected?.what === "thing", thing), ...colored,
      points: points(outline(side, thing, thing.center, rotation)),
    },
  };
  if (thing.track.length === 0) return [body];
  const way = thing.track.map(({ center }) => onBoard(side, center));
  const path: BoardShape = {
    id: `track ${i}`, tag: "path",
    attributes: { class: "track", d: `M${way.map((at) => at.join(" ")).join("L")}${thing.repeat === "loop" ? "Z" : ""}`, "aria-hidden": "true" },
  };
  if (!isSelected) return [path, body];
  return [path, body, ...thing.track.map((key, k) => keyShape(way[k] ?? [0, 0], key.center, i, k, selected?.what === "key" && selected.key === k, pixel))];
}

function keyShape([u, v]: Vec2, center: Vec3, i: number, k: number, pressed: boolean, pixel: number): BoardShape {
  return {
    id: `key ${i} ${k}`, tag: "circle",
    attributes: { ...worked("key", text("build.point", k + 1), pressed, { center }), cx: String(u), cy: String(v), r: String(HANDLE * pixel) },
  };
}

/** The handles of what is selected, in the view from above. */
function handles({ plan, selected, thing }: Editor, pixel: number): BoardShape[] {
  if (!selected || selected.what === "key" || selected.what === "stop") return [];
  const spot = selected.what === "start" ? plan.start : selected.what === "finish" ? plan.finish : null;
  const center: Vec3 = spot ? [spot.x, 0, spot.z] : (thing?.center ?? [0, 0, 0]);
  const heading = spot ? spot.heading : thing ? yawOf(thing) : 0;
  const [x, , z] = thing ? halfSize(thing.shape) : selected.what === "finish" ? [plan.finish.width / 2, 0, 0] : [0.3, 0, 0.3];
  const at = (ahead: number, left: number): Vec2 => onBoard("top", [
    center[0] + ahead * Math.sin(heading) + left * Math.cos(heading), 0, center[2] + ahead * Math.cos(heading) - left * Math.sin(heading)]);
  const dot = (id: string, [u, v]: Vec2): BoardShape => ({
    id, tag: "circle", attributes: { class: `handle ${id}`, cx: String(u), cy: String(v), r: String(HANDLE * pixel), "aria-hidden": "true" },
  });
  const turn = dot("turn", at(z + 24 * pixel, 0));
  return selected.what === "start" ? [turn] : [turn, dot("size", at(z, x))];
}

function cross([u, v]: Vec2, r: number): BoardShape {
  const d = `M${u - r} ${v - r}l${2 * r} ${2 * r}M${u - r} ${v + r}l${2 * r} ${-2 * r}`;
  return { id: "mark", tag: "path", attributes: { class: "stuck-mark", d, "aria-hidden": "true" } };
}

/** Attributes of what can be reached and worked. */
function worked(kind: string, title: string, pressed: boolean, at: { readonly center: Vec3 } | Spot): Record<string, string> {
  const [x, z] = "center" in at ? [at.center[0], at.center[2]] : [at.x, at.z];
  return {
    class: kind, tabindex: "0", role: "button", "aria-pressed": String(pressed),
    "aria-label": text("build.at", title, x.toFixed(2), z.toFixed(2)),
  };
}

function points(corners: readonly Vec2[]): string {
  return corners.map(([u, v]) => `${u.toFixed(4)},${v.toFixed(4)}`).join(" ");
}
