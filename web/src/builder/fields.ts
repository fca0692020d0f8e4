/** The numbers of what is selected, to be read and typed: a table of fields for each kind of thing. */

import { VIEW_NAMES, VIEWS } from "../camera/views";
import { text, type TextName } from "../texts/texts";
import { worded } from "../texts/worded";
import { atPace, changed, moved, paceOf, reshaped, restopped, tidy, turnedBy, yawOf, type Selected } from "./edits";
import type { Editor } from "./editor";
import { REPEATS, type Plan, type Repeat, type Shape, type Spot, type Thing, type TourStop, type Vec3 } from "./plan";
import { halfSize, length } from "./shapes";
import { anglesOf, turnOf, wrapped } from "./turns";

export interface NumberField {
  readonly kind: "number";
  readonly name: TextName;
  /** Null where nothing is said. */
  readonly value: number | null;
  readonly step: number;
  set(value: number): Plan;
  /** Where it may be left empty. */
  unset?(): Plan;
}

export interface TextField {
  readonly kind: "text" | "color";
  readonly name: TextName;
  readonly value: string;
  set(value: string): Plan;
}

export interface ChoiceField {
  readonly kind: "choice";
  readonly name: TextName;
  readonly value: string;
  readonly choices: readonly (readonly [string, string])[];
  set(value: string): Plan;
}

export type Field = NumberField | TextField | ChoiceField;

const DEGREE = Math.PI / 180;

/** The fields of what is selected; of the ground, where nothing is. */
export function fieldsOf({ plan, selected, thing, index }: Editor): readonly Field[] {
  if (!selected) return groundFields(plan);
  if (selected.what === "start") return spotFields(plan, selected, plan.start);
  if (selected.what === "finish") {
    const { finish } = plan;
    return [...spotFields(plan, selected, finish), metres("build.width", finish.width, (width) => ({ ...plan, finish: { ...finish, width: length(width) } }))];
  }
  if (selected.what === "stop") return stopFields(plan, selected);
  if (!thing || index === null) return [];
  if (selected.what === "key") return keyFields(plan, selected, thing, selected.key);
  return [...lookFields(plan, thing, index), ...placeFields(plan, selected, thing), ...shapeFields(plan, thing, index), ...trackFields(plan, thing, index)];
}

function groundFields(plan: Plan): Field[] {
  const { ground } = plan;
  return [
    metres("build.wide", ground.size[0], (wide) => ({ ...plan, ground: { ...ground, size: [length(wide), ground.size[1]] } })),
    metres("build.long", ground.size[1], (long) => ({ ...plan, ground: { ...ground, size: [ground.size[0], length(long)] } })),
    metres("build.x", ground.center[0], (x) => ({ ...plan, ground: { ...ground, center: [tidy(x), ground.center[1]] } })),
    metres("build.z", ground.center[1], (z) => ({ ...plan, ground: { ...ground, center: [ground.center[0], tidy(z)] } })),
  ];
}

function spotFields(plan: Plan, selected: Selected, { x, z, heading }: Spot): Field[] {
  return [
    metres("build.x", x, (to) => moved(plan, selected, [to - x, 0, 0])), metres("build.z", z, (to) => moved(plan, selected, [0, 0, to - z])),
    degrees("build.turn", heading, (to) => turnedBy(plan, selected, wrapped(to - heading))),
  ];
}

function stopFields(plan: Plan, selected: Selected & { readonly what: "stop" }): Field[] {
  const stop = plan.tour[selected.index];
  if (!stop) return [];
  const change = (to: Partial<TourStop>) => restopped(plan, selected.index, () => to);
  return [
    metres("build.x", stop.x, (to) => moved(plan, selected, [to - stop.x, 0, 0])), metres("build.z", stop.z, (to) => moved(plan, selected, [0, 0, to - stop.z])),
    { kind: "number", name: "build.floor", value: stop.height, step: 0.05, set: (to) => change({ height: tidy(to) }), unset: () => change({ height: null }) },
    {
      kind: "choice", name: "build.view", value: stop.view, set: (view) => change({ view }),
      choices: [["", text("build.sameView")], ...VIEW_NAMES.map((name) => [name, worded(VIEWS[name].title)] as const)],
    },
    { kind: "number", name: "build.stay", value: stop.seconds, step: 1, set: (to) => change({ seconds: Math.min(600, Math.max(0, to)) }) },
    { kind: "text", name: "build.say", value: stop.say, set: (say) => change({ say: say.slice(0, 300) }) },
  ];
}

function keyFields(plan: Plan, selected: Selected, thing: Thing, k: number): Field[] {
  const key = thing.track[k];
  if (!key) return [];
  return [...middleFields(plan, selected, key.center, 0), degrees("build.turn", key.yaw, (to) => turnedBy(plan, selected, wrapped(to - key.yaw)))];
}

function lookFields(plan: Plan, { name, color }: Thing, index: number): Field[] {
  return [
    { kind: "text", name: "build.name", value: name, set: (to) => changed(plan, index, { name: to }) },
    { kind: "color", name: "build.color", value: color, set: (to) => changed(plan, index, { color: to }) },
  ];
}

function placeFields(plan: Plan, selected: Selected, thing: Thing): Field[] {
  const low = halfSize(thing.shape)[1], yaw = yawOf(thing);
  const turn = degrees("build.turn", yaw, (to) => turnedBy(plan, selected, wrapped(to - yaw)));
  const fields = [...middleFields(plan, selected, thing.center, low), turn];
  if (thing.track.length > 0 || thing.shape.type === "sphere" || selected.what !== "thing") return fields;
  const [x, y, z] = anglesOf(thing.rotation);
  const tilt = (angles: Vec3) => changed(plan, selected.index, { rotation: turnOf(angles) });
  return [...fields, degrees("build.lean", x, (to) => tilt([to, y, z])), degrees("build.roll", z, (to) => tilt([x, y, to]))];
}

/** Where it is; its height is that of its lower side while it is upright. */
function middleFields(plan: Plan, selected: Selected, [x, y, z]: Vec3, low: number): Field[] {
  return [
    metres("build.x", x, (to) => moved(plan, selected, [to - x, 0, 0])),
    metres(low > 0 ? "build.bottom" : "build.y", y - low, (to) => moved(plan, selected, [0, to - y + low, 0])),
    metres("build.z", z, (to) => moved(plan, selected, [0, 0, to - z])),
  ];
}

function shapeFields(plan: Plan, { shape }: Thing, index: number): Field[] {
  const size = (name: TextName, value: number, made: (metres: number) => Shape) => metres(name, value, (to) => reshaped(plan, index, made(length(to))));
  switch (shape.type) {
    case "box": {
      const [x, y, z] = shape.size;
      return [
        size("build.wide", x, (to) => ({ type: "box", size: [to, y, z] })), size("build.high", y, (to) => ({ type: "box", size: [x, to, z] })),
        size("build.long", z, (to) => ({ type: "box", size: [x, y, to] })),
      ];
    }
    case "sphere":
      return [size("build.radius", shape.radius, (radius) => ({ type: "sphere", radius }))];
    case "capsule":
      return [
        size("build.radius", shape.radius, (radius) => ({ ...shape, radius })), size("build.line", shape.length, (to) => ({ ...shape, length: to })),
      ];
    case "cylinder":
      return [size("build.radius", shape.radius, (radius) => ({ ...shape, radius })), size("build.high", shape.height, (height) => ({ ...shape, height }))];
    case "hull":
    case "mesh":
      return [];
  }
}

function trackFields(plan: Plan, thing: Thing, index: number): Field[] {
  if (thing.track.length === 0) return [];
  return [
    { kind: "number", name: "build.pace", value: paceOf(thing), step: 0.1, set: (to) => atPace(plan, index, Math.min(20, Math.max(0.05, to))) },
    {
      kind: "choice", name: "build.repeat", value: thing.repeat, choices: REPEATS.map((repeat) => [repeat, text(`build.${repeat}`)]),
      set: (to) => changed(plan, index, { repeat: REPEATS.find((repeat) => repeat === to) ?? ("loop" satisfies Repeat) }),
    },
  ];
}

function metres(name: TextName, value: number, set: (value: number) => Plan): NumberField {
  return { kind: "number", name, value, step: 0.05, set };
}

function degrees(name: TextName, value: number, set: (radians: number) => Plan): NumberField {
  return { kind: "number", name, value: value / DEGREE, step: 5, set: (to) => set(to * DEGREE) };
}
