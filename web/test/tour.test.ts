import { expect, test } from "vitest";
import type { Going, Stop } from "../src/generated/messages";
import { GuidedTour } from "../src/going/tour";

const STOPS: readonly Stop[] = [
  { position: [0, 1], height: null, view: "side", say: "Here it begins.", seconds: 2 },
  { position: [1, 4], height: 2.5, view: "", say: "", seconds: 0 },
];

function toured() {
  const done: string[] = [];
  const due: (() => void)[] = [];
  const tour = new GuidedTour({
    send: (message) => done.push(message.type === "goto" ? `goto ${message.place.join(" ")}` : message.type),
    look: (view) => done.push(view), say: (_, said) => done.push(said),
    after: (seconds, then) => {
      done.push(`wait ${seconds}`);
      due.push(then);
      return () => done.push("called off");
    },
  });
  const hear = (state: Going["state"], place: [number, number]) => tour.heard({ type: "going", state, place: [place[0], 0, place[1]], reason: "", nearest: null });
  return { tour, done, due, hear };
}

test("a tour goes from stop to stop, looks, waits, and ends", () => {
  const { tour, done, due, hear } = toured();
  tour.toggle(STOPS);
  hear("walking", [0, 1]);
  expect(done).toEqual(["side", "Here it begins.", "goto 0  1"]);
  hear("arrived", [5, 5]);
  expect(tour.at).toBe(0);
  hear("arrived", [0, 1]);
  hear("arrived", [0, 1]);
  due.pop()?.();
  expect(done.slice(3)).toEqual(["wait 2", "goto 1 2.5 4"]);
  hear("given up", [1, 4]);
  due.pop()?.();
  expect(tour.at).toBeNull();
});

test("who steers ends it, and so does a second press", () => {
  const { tour, done, hear } = toured();
  tour.toggle(STOPS);
  hear("taken over", [0, 1]);
  expect(tour.at).toBeNull();
  tour.toggle(STOPS);
  hear("arrived", [0, 1]);
  tour.toggle(STOPS);
  expect(tour.at).toBeNull();
  expect(done.at(-1)).toBe("called off");
  tour.toggle([]);
  expect(tour.at).toBeNull();
});
