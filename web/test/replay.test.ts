import { describe, expect, it } from "vitest";
import { POSE_FLAGS, POSE_PHASES, type AvatarMessage, type PoseFrame, type SceneMessage } from "../src/generated/messages";
import { curvesOf, degreesBetween } from "../src/replay/curves";
import { WalkKeeper } from "../src/replay/keeper";
import { marksOf } from "../src/replay/marks";
import { Player } from "../src/replay/player";
import { packed } from "../src/replay/save";
import { NOTHING_LOOSE } from "../src/stage/loose";
import { durationOf, frameAt, hasAssist, poseAt, samePlace, type Take } from "../src/replay/take";

const SCENE = { name: "a", title: "Scene A", obstacles: [] } as unknown as SceneMessage;
const AVATAR = { revision: 1, bones: [{ name: "hips", node: 0 }, { name: "leftLowerArm", node: 1 }], capsules: [] } as unknown as AvatarMessage;
const HERE = { scene: SCENE, loose: NOTHING_LOOSE, avatar: AVATAR, planner: "exact" };
const PLAY = POSE_PHASES.indexOf("play");

function frame(simTime: number, changes: Partial<PoseFrame> = {}): PoseFrame {
  const rotations = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1]);
  const base = { flags: POSE_FLAGS.assist, epoch: 1, avatarRevision: 1, phase: PLAY, jointCount: 2, x: 0, z: simTime, heading: 0, forward: 1 };
  return { ...base, lateral: 0, turn: 0, clearance: 0.1, rotations, capsules: new Float32Array(), time: 100 + simTime, simTime, ...changes } as PoseFrame;
}

function walk(seconds: number, change: (time: number) => Partial<PoseFrame> = () => ({})): Take {
  const keeper = new WalkKeeper();
  for (let i = 0; i <= 60 * seconds; i++) keeper.add(frame(i / 60, change(i / 60)), HERE);
  return keeper.takes()[0] as Take;
}

describe("the keeper", () => {
  it("keeps a walk from a moment before it sets off, on a time line of its own", () => {
    const take = walk(5, (time) => ({ forward: time < 2 ? 0 : 1 }));
    expect(take.frames[0]?.time).toBe(0);
    expect(durationOf(take)).toBeGreaterThan(3);
    expect(durationOf(take)).toBeLessThan(3.5);
    expect(take.frames.every((one, i) => i === 0 || one.time > (take.frames[i - 1] as PoseFrame).time)).toBe(true);
  });

  it("begins anew after a jump, another avatar and a clip, and leaves pauses out", () => {
    const keeper = new WalkKeeper();
    const go = (epoch: number, changes: Partial<PoseFrame> = {}) => {
      for (let i = 0; i <= 120; i++) keeper.add(frame(i / 60, { epoch, ...changes }), HERE);
    };
    go(1);
    for (let i = 0; i < 50; i++) keeper.add(frame(2, { epoch: 1, time: 200 + i }), HERE);
    go(2);
    keeper.add(frame(3, { epoch: 2 }), null);
    go(3);
    keeper.add(frame(3, { epoch: 3, avatarRevision: 2 }), HERE);
    expect(keeper.takes().map(({ frames }) => frames.length)).toEqual([121, 121, 121]);
    expect(new Set(keeper.takes().map(({ id }) => id)).size).toBe(3);
  });

  it("forgets the oldest first, and never keeps more than it may", () => {
    const keeper = new WalkKeeper(1000);
    for (let epoch = 0; epoch < 7; epoch++) for (let i = 0; i < 300; i++) keeper.add(frame(i / 60, { epoch }), HERE);
    expect(keeper.takes().length).toBe(3);
    for (let i = 0; i < 5000; i++) keeper.add(frame(i / 60, { epoch: 9 }), HERE);
    const kept = keeper.takes();
    const frames = kept.flatMap((take) => take.frames);
    expect(kept.length).toBe(2);
    expect(frames.length).toBeLessThanOrEqual(1000);
    expect(frames.at(-1)?.simTime).toBeCloseTo(4999 / 60);
  });

  it("only adds to a walk that it has told of: what is kept of one goes on where it ended", () => {
    const keeper = new WalkKeeper(1000);
    const told = new Map<number, number[]>();
    for (let i = 0; i < 3000; i++) {
      keeper.add(frame(i / 60), HERE);
      if (i % 97 > 0) continue;
      for (const { id, frames } of keeper.takes()) {
        const before = told.get(id) ?? [];
        const now = frames.map(({ simTime }) => simTime);
        expect(now.slice(0, before.length)).toEqual(before);
        told.set(id, now);
      }
    }
    expect(told.size).toBeGreaterThan(4);
  });

  it("keeps no standing", () => {
    const keeper = new WalkKeeper();
    for (let i = 0; i < 600; i++) keeper.add(frame(i / 60, { forward: 0 }), HERE);
    expect(keeper.takes()).toEqual([]);
  });
});

describe("a take", () => {
  const take = walk(3);

  it("is found by time, as a search from the front finds it", () => {
    for (let i = 0; i < 200; i++) {
      const time = -0.5 + (4 * i) / 200;
      const slow = Math.max(0, take.frames.filter((one) => one.time <= time).length - 1);
      expect(frameAt(take.frames, time)).toBe(slow);
    }
  });

  it("is blended between frames and held at its ends", () => {
    const first = take.frames[0] as PoseFrame;
    expect(poseAt(take, 1.2345).z).toBeCloseTo(first.z + 1.2345);
    expect(poseAt(take, -1).z).toBe(first.z);
    expect(poseAt(take, 99).z).toBe(take.frames.at(-1)?.z);
  });

  it("knows its assist and its place", () => {
    expect(hasAssist(take)).toBe(true);
    expect(hasAssist(walk(2, () => ({ flags: 0 })))).toBe(false);
    expect(samePlace(take, { ...take, scene: { ...SCENE } })).toBe(true);
    expect(samePlace(take, { ...take, scene: { ...SCENE, name: "b" } })).toBe(false);
  });

  it("tells what happened when", () => {
    const marks = marksOf(walk(4, (time) => ({
      phase: Math.abs(time - 1) < 1e-9 ? 0 : PLAY,
      flags: (time > 2 && time < 2.5 ? POSE_FLAGS.stuck : 0) | (time > 3 ? POSE_FLAGS.finished : 0),
    })));
    expect(marks.map(({ kind }) => kind)).toEqual(["plan", "stuck", "crossed"]);
    expect(marks[1]?.until).toBeGreaterThan((marks[1]?.time ?? 9) + 0.4);
    expect(marks[2]?.until).toBe(marks[2]?.time);
  });

  it("has curves of clearance and of the angles from its beginning", () => {
    const bend = (time: number) => new Float32Array([0, 0, 0, 1, Math.sin(time / 2), 0, 0, Math.cos(time / 2)]);
    const bent = walk(2, (time) => ({ rotations: bend(time), clearance: Math.abs(time - 1) < 1e-9 ? 0.01 : 0.2 }));
    const { clearance, joints } = curvesOf(bent, durationOf(bent), 50);
    expect(Math.min(...clearance)).toBeCloseTo(0.01);
    const oneFrame = 180 / Math.PI / 60;
    expect(Math.abs((joints.leftElbow.at(-1) ?? 0) - (180 / Math.PI) * 2 * (49 / 50))).toBeLessThan(oneFrame);
    expect(Math.max(...joints.trunk)).toBe(0);
    expect(degreesBetween([0, 0, 0, 1], [0, 0, 0, -1])).toBeCloseTo(0);
  });
});

describe("the player", () => {
  it("plays at its speed to the end, begins anew, loops and steps", () => {
    const player = new Player(2);
    player.toggle();
    player.speed = 0.5;
    player.advance(1);
    expect(player.time).toBeCloseTo(0.5);
    player.advance(9);
    expect([player.time, player.playing]).toEqual([2, false]);
    player.toggle();
    expect([player.time, player.playing]).toEqual([0, true]);
    player.loop = true;
    player.advance(5);
    expect(player.time).toBeCloseTo(0.5);
    player.step(-3);
    expect([player.playing, player.time]).toEqual([false, expect.closeTo(0.45)]);
    player.step(-100);
    expect(player.time).toBe(0);
  });
});

describe("saving", () => {
  it("packs every frame as the server reads it", () => {
    const take = walk(2, () => ({ epoch: 3, y: 0.5, hipsX: 1, hipsY: 2, hipsZ: 3 }));
    const numbers = packed(take);
    const size = 9 + 4 * 2;
    expect(numbers.length).toBe(size * take.frames.length);
    const second = take.frames[1] as PoseFrame;
    const head = [second.time, 3, second.x, 0.5, second.z, second.heading, 1, 2, 3].map(Math.fround);
    expect([...numbers.subarray(size, 2 * size)]).toEqual([...head, 0, 0, 0, 1, 0, 0, 0, 1]);
  });
});
