import { describe, expect, it } from "vitest";
import { POSE_HEAD_SIZE, POSE_KIND, POSE_LAYOUT, readPoseFrame, type PoseFrame } from "../src/generated/messages";
import { PoseTimeline } from "../src/net/pose_timeline";
import { slerpInto } from "../src/net/slerp";

function message(joints: number, capsules: number): ArrayBuffer {
  const buffer = new ArrayBuffer(POSE_HEAD_SIZE + 16 * joints + 24 * capsules);
  const view = new DataView(buffer);
  view.setUint8(0, POSE_KIND);
  view.setUint8(1, POSE_LAYOUT);
  view.setFloat64(8, 12.5, true);
  view.setUint16(34, joints, true);
  view.setUint16(36, capsules, true);
  view.setFloat32(72, Infinity, true);
  for (let j = 0; j < joints; j++) view.setFloat32(POSE_HEAD_SIZE + 16 * j + 12, 1, true);
  return buffer;
}

function frame(time: number, x: number, changes: Partial<PoseFrame> = {}): PoseFrame {
  const base = readPoseFrame(message(2, 1)) as PoseFrame;
  return { ...base, time, x, ...changes };
}

describe("readPoseFrame", () => {
  it("reads what it should and refuses the rest", () => {
    const read = readPoseFrame(message(3, 2));
    expect(read).toMatchObject({ time: 12.5, jointCount: 3, capsuleCount: 2, clearance: Infinity });
    expect(read?.rotations.length).toBe(12);
    expect(read?.capsules.length).toBe(12);
    expect(readPoseFrame(message(3, 2).slice(0, -4))).toBeNull();
    expect(readPoseFrame(new ArrayBuffer(3))).toBeNull();
    const other = message(1, 0);
    new DataView(other).setUint8(1, POSE_LAYOUT + 1);
    expect(readPoseFrame(other)).toBeNull();
  });
});

describe("PoseTimeline", () => {
  it("interpolates between its frames and holds at the ends", () => {
    const line = new PoseTimeline();
    expect(line.sample(1)).toBeNull();
    for (let i = 0; i < 5; i++) line.push(frame(i, i * i));
    expect(line.sample(2.5)?.x).toBeCloseTo(6.5, 12);
    expect(line.sample(-1)?.x).toBe(0);
    expect(line.sample(9)).toMatchObject({ x: 16, starved: true });
  });

  it("drops what comes out of order", () => {
    const line = new PoseTimeline();
    line.push(frame(2, 2));
    line.push(frame(1, 1));
    expect(line.newest?.x).toBe(2);
    expect(line.sample(1.5)?.x).toBe(2);
  });

  it("does not blend across a jump", () => {
    const line = new PoseTimeline();
    line.push(frame(0, 0));
    line.push(frame(1, 50, { epoch: 1 }));
    expect(line.sample(0.5)?.x).toBe(0);
    expect(line.sample(1)?.x).toBe(50);
  });

  it("blends rotations and capsules", () => {
    const quarter = new Float32Array([0, Math.SQRT1_2, 0, Math.SQRT1_2, 0, 0, 0, -1]);
    const line = new PoseTimeline();
    line.push(frame(0, 0, { capsules: new Float32Array([0, 0, 0, 0, 0, 0]) }));
    line.push(frame(1, 0, { rotations: quarter, capsules: new Float32Array([2, 0, 0, 0, 4, 0]) }));
    const half = line.sample(0.5);
    expect(half?.rotations[1]).toBeCloseTo(Math.sin(Math.PI / 8), 6);
    expect(Math.abs(half?.rotations[7] ?? 0)).toBeCloseTo(1, 6);
    expect(half?.capsules[0]).toBeCloseTo(1, 6);
    expect(half?.capsules[4]).toBeCloseTo(2, 6);
  });
});

describe("slerpInto", () => {
  it("turns at a constant rate and stays of unit length", () => {
    const a = [0, 0, 0, 1];
    const b = [Math.sin(0.6), 0, 0, Math.cos(0.6)];
    const out = new Float32Array(4);
    for (let share = 0; share <= 1; share += 0.1) {
      slerpInto(out, 0, a, b, share);
      expect(Math.hypot(...out)).toBeCloseTo(1, 6);
      expect(2 * Math.atan2(out[0] ?? 0, out[3] ?? 0)).toBeCloseTo(1.2 * share, 5);
    }
  });
});
