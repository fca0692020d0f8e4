/** Edits: each makes a new plan of a plan and what is selected in it. Metres and radians. */

import type { Key, Plan, Shape, Spot, Thing, TourStop, Vec3 } from "./plan";
import { UPRIGHT } from "./plan";
import { fresh, halfSize, scaled, type Kind } from "./shapes";
import { aboutY, after, wrapped } from "./turns";

/** What an edit is about. */
export type Selected =
  | { readonly what: "thing"; readonly index: number }
  | { readonly what: "key"; readonly index: number; readonly key: number }
  | { readonly what: "stop"; readonly index: number }
  | { readonly what: "start" }
  | { readonly what: "finish" };

/** The most of each; the server allows more, a board does not show more. */
export const MOST_THINGS = 500;
export const MOST_KEYS = 50;
export const MOST_STOPS = 100;
const FARTHEST = 10_000;
/** m/s at which a new track is gone along. */
const PACE = 0.8;
const NAME = 100;

/** A new thing that stands on the ground; null where there are too many. */
export function placed(plan: Plan, kind: Kind, x: number, z: number, title: string): Plan | null {
  if (plan.things.length >= MOST_THINGS) return null;
  const shape = fresh(kind);
  const thing: Thing = {
    name: freeName(plan, title), color: "", shape, center: [x, halfSize(shape)[1], z], rotation: UPRIGHT, track: [], repeat: "pingpong",
  };
  return { ...plan, things: [...plan.things, thing] };
}

/** One thing changed; its name stays one that it may have. */
export function changed(plan: Plan, index: number, change: Partial<Thing>): Plan {
  const name = change.name === undefined ? {} : { name: change.name.trim().slice(0, NAME) || (plan.things[index]?.name ?? "") };
  return { ...plan, things: plan.things.map((thing, i) => (i === index ? { ...thing, ...change, ...name } : thing)) };
}

/** The selected moved by so much. */
export function moved(plan: Plan, selected: Selected, by: Vec3): Plan {
  const spot = <S extends Spot>(one: S): S => ({ ...one, x: tidy(one.x + by[0]), z: tidy(one.z + by[2]) });
  const shift = ([x, y, z]: Vec3): Vec3 => [tidy(x + by[0]), tidy(y + by[1]), tidy(z + by[2])];
  switch (selected.what) {
    case "start":
      return { ...plan, start: spot(plan.start) };
    case "finish":
      return { ...plan, finish: spot(plan.finish) };
    case "stop":
      return restopped(plan, selected.index, ({ x, z, height }) =>
        ({ x: tidy(x + by[0]), z: tidy(z + by[2]), height: by[1] === 0 ? height : tidy((height ?? 0) + by[1]) }));
    case "key":
      return rekeyed(plan, selected.index, (key, i) => (i === selected.key ? { ...key, center: shift(key.center) } : key));
    case "thing": {
      const thing = plan.things[selected.index];
      const track = thing?.track.map((key) => ({ ...key, center: shift(key.center) })) ?? [];
      return thing ? changed(plan, selected.index, { center: shift(thing.center), track }) : plan;
    }
  }
}

/** The selected turned about Y. */
export function turnedBy(plan: Plan, selected: Selected, angle: number): Plan {
  const spot = <S extends Spot>(one: S): S => ({ ...one, heading: wrapped(one.heading + angle) });
  switch (selected.what) {
    case "start":
      return { ...plan, start: spot(plan.start) };
    case "finish":
      return { ...plan, finish: spot(plan.finish) };
    case "stop":
      return plan;
    case "key":
      return rekeyed(plan, selected.index, (key, i) => (i === selected.key ? { ...key, yaw: wrapped(key.yaw + angle) } : key));
    case "thing": {
      const thing = plan.things[selected.index];
      if (!thing) return plan;
      const track = thing.track.map((key) => ({ ...key, yaw: wrapped(key.yaw + angle) }));
      return changed(plan, selected.index, { rotation: after(thing.rotation, aboutY(angle)), track });
    }
  }
}

/** The selected larger or smaller; what stands on the ground goes on standing there. */
export function scaledBy(plan: Plan, selected: Selected, factor: number): Plan {
  if (selected.what === "finish") return { ...plan, finish: { ...plan.finish, width: tidy(Math.max(0.2, plan.finish.width * factor)) } };
  if (selected.what === "start" || selected.what === "stop") return plan;
  const thing = plan.things[selected.index];
  return thing ? reshaped(plan, selected.index, scaled(thing.shape, factor)) : plan;
}

/** A thing of another shape, its lower side where it was. */
export function reshaped(plan: Plan, index: number, shape: Shape): Plan {
  const thing = plan.things[index];
  if (!thing) return plan;
  const upright = Math.abs(thing.rotation[0]) + Math.abs(thing.rotation[2]) < 1e-6;
  const rise = upright ? halfSize(shape)[1] - halfSize(thing.shape)[1] : 0;
  const lift = ([x, y, z]: Vec3): Vec3 => [x, tidy(y + rise), z];
  const track = thing.track.map((key) => ({ ...key, center: lift(key.center) }));
  return changed(plan, index, { shape, center: lift(thing.center), track });
}

/** The plan with a copy of a thing beside it; null where there are too many. */
export function copied(plan: Plan, index: number, aside: number): Plan | null {
  const thing = plan.things[index];
  if (!thing || plan.things.length >= MOST_THINGS) return null;
  const copy = { ...thing, name: freeName(plan, thing.name.replace(/ \d+$/, "")) };
  const things = [...plan.things, copy];
  return moved({ ...plan, things }, { what: "thing", index: things.length - 1 }, [aside, 0, 0]);
}

/** The plan with another stop of its tour; null where there are too many. */
export function stopped(plan: Plan, x: number, z: number): Plan | null {
  if (plan.tour.length >= MOST_STOPS) return null;
  return { ...plan, tour: [...plan.tour, { x: tidy(x), z: tidy(z), height: null, view: "", say: "", seconds: 3 }] };
}

/** A stop of the tour changed. */
export function restopped(plan: Plan, index: number, change: (stop: TourStop) => Partial<TourStop>): Plan {
  return { ...plan, tour: plan.tour.map((stop, i) => (i === index ? { ...stop, ...change(stop) } : stop)) };
}

/** The plan without the selected: a thing, a point of its track, or a stop of the tour; start and finish stay. */
export function removed(plan: Plan, selected: Selected): Plan {
  if (selected.what === "thing") return { ...plan, things: plan.things.filter((_, i) => i !== selected.index) };
  if (selected.what === "stop") return { ...plan, tour: plan.tour.filter((_, i) => i !== selected.index) };
  if (selected.what !== "key") return plan;
  const track = plan.things[selected.index]?.track.filter((_, i) => i !== selected.key) ?? [];
  return changed(plan, selected.index, settled(plan.things[selected.index], track));
}

/** A point added to a thing's track; what stood begins where it stood. */
export function extended(plan: Plan, index: number, x: number, z: number): Plan {
  const thing = plan.things[index];
  if (!thing || thing.track.length >= MOST_KEYS) return plan;
  const first: Key = { center: thing.center, yaw: yawOf(thing), seconds: 1 };
  const track = thing.track.length > 0 ? thing.track : [first];
  const last = track[track.length - 1] ?? first;
  const center: Vec3 = [tidy(x), last.center[1], tidy(z)];
  const heading = { rotation: UPRIGHT };
  return changed(plan, index, { ...heading, track: paced([...track, { center, yaw: last.yaw, seconds: 1 }], PACE) });
}

/** A thing's track gone along at a speed, m/s. */
export function atPace(plan: Plan, index: number, speed: number): Plan {
  const thing = plan.things[index];
  return thing ? changed(plan, index, { track: paced(thing.track, speed) }) : plan;
}

/** The speed along the first stretch of a track, m/s. */
export function paceOf({ track }: Thing): number {
  const [a, b] = track;
  return a && b ? apart(a, b) / a.seconds : PACE;
}

/** The turn about Y of what stands upright or goes along a track. */
export function yawOf({ rotation: [x, y, z, w], track }: Thing): number {
  return track[0]?.yaw ?? Math.atan2(2 * (w * y + x * z), 1 - 2 * (x * x + y * y));
}

/** To a tenth of a millimetre, and within what a scene allows. */
export function tidy(metres: number): number {
  return Math.min(FARTHEST, Math.max(-FARTHEST, Math.round(metres * 1e4) / 1e4));
}

function rekeyed(plan: Plan, index: number, change: (key: Key, i: number) => Key): Plan {
  const thing = plan.things[index];
  return thing ? changed(plan, index, settled(thing, paced(thing.track.map(change), paceOf(thing)))) : plan;
}

/** A thing stands where its track begins, and for good where that has only one point. */
function settled(thing: Thing | undefined, track: readonly Key[]): Partial<Thing> {
  const [first] = track;
  if (!thing || !first) return { track };
  if (track.length === 1) return { track: [], center: first.center, rotation: aboutY(first.yaw) };
  return { track, center: first.center };
}

function paced(track: readonly Key[], speed: number): readonly Key[] {
  return track.map((key, i) => {
    const next = track[(i + 1) % track.length] ?? key;
    const seconds = Math.max(apart(key, next) / Math.max(speed, 0.01), Math.abs(next.yaw - key.yaw) / 2, 0.1);
    return { ...key, seconds: Math.min(3600, Math.round(seconds * 1000) / 1000) };
  });
}

function apart(a: Key, b: Key): number {
  return Math.hypot(...a.center.map((value, i) => value - (b.center[i] ?? 0)));
}

function freeName({ things }: Plan, title: string): string {
  const taken = new Set(things.map(({ name }) => name));
  for (let n = 1; ; n++) if (!taken.has(`${title} ${n}`)) return `${title} ${n}`;
}
