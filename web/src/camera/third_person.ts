/** The third-person camera: orbits a pivot at the avatar's shoulders on a spring arm that no wall can enter. */

import { damp, dampAngle } from "./damping";
import { backwards, NO_SHIFT, roomierView, type ViewShift } from "./roomier_view";
import { distanceToBox, distanceToBoxes, freeReach, type PreparedBox, type Vec3 } from "./spring_arm";

const DEFAULT_PITCH = 0.3;
const MIN_PITCH = -0.25;
const MAX_PITCH = 1.35;
const MIN_ARM = 0.35;
const MIN_WANTED = 1.2;
const MAX_WANTED = 9;
/** A sphere of this radius round the camera never touches a box: more than the near plane's corner is away. */
const HARD_RADIUS = 0.14;
/** Within this of a box the arm begins to give way, so that it seldom has to jump. */
const SOFT_RADIUS = 0.42;
const IN_HALFLIFE = 0.035;
const OUT_HALFLIFE = 0.35;
const ZOOM_HALFLIFE = 0.06;
const PIVOT_HALFLIFE = 0.05;
const RECENTER_HALFLIFE = 0.16;
const FOLLOW_RATE = 1.1;
/** Boxes this near to the pivot cannot hold the arm back: it begins inside them. */
const AROUND_PIVOT = 0.02;
const STEEPEST = 1.5;
const PITCH_STEP = 0.12;
const FADE_NEAR = 0.5;
const FADE_FAR = 1.15;
const SHIFT_HALFLIFE = 0.14;

/** Where the avatar is and what the user does with it. */
export interface Followed {
  readonly x: number;
  readonly z: number;
  readonly heading: number;
  /** Height of the point that the camera looks at, metres. */
  readonly eye: number;
  /** How far the stick points sideways, -1 to 1, positive to the right. */
  readonly sideways: number;
  /** Whether the camera shall come round behind the avatar by itself. */
  readonly trail: boolean;
}

export class ThirdPersonCamera {
  /** Where the camera looks, radians about +Y; the avatar's heading when it is straight behind. */
  heading = 0;
  /** Above the horizon, radians. */
  pitch = DEFAULT_PITCH;
  private wanted = 3.9;
  private zoomed = 3.9;
  private arm = 3.9;
  private shift: ViewShift = NO_SHIFT;
  private shiftedYaw = 0;
  private shiftedPitch = 0;
  private recentering = false;
  private pivot: [number, number, number] = [0, 1.4, 0];
  private at: [number, number, number] = [0, 2, -3.9];

  /** With reduced motion nothing moves by itself and nothing lags. */
  constructor(private readonly calm: () => boolean) {}

  get position(): Vec3 {
    return this.at;
  }

  get target(): Vec3 {
    return this.pivot;
  }

  /** Opacity of the avatar: it fades when the camera is pushed into its back. */
  get avatarOpacity(): number {
    return Math.min(1, Math.max(0, (this.arm - FADE_NEAR) / (FADE_FAR - FADE_NEAR)));
  }

  /** Turns by a drag, radians. */
  turn(yaw: number, pitch: number): void {
    this.heading -= yaw;
    this.pitch = Math.min(MAX_PITCH, Math.max(MIN_PITCH, this.pitch + pitch));
    this.recentering = false;
  }

  /** Zooms by a factor; above 1 is further away. */
  zoom(factor: number): void {
    this.wanted = Math.min(MAX_WANTED, Math.max(MIN_WANTED, this.wanted * factor));
  }

  /** Asks the camera to come round behind the avatar. */
  recenter(): void {
    this.recentering = true;
  }

  /** Puts the camera straight behind, at once: a new scene or a reset. */
  snap(followed: Followed): void {
    this.heading = followed.heading;
    this.pitch = DEFAULT_PITCH;
    this.pivot = [followed.x, followed.eye, followed.z];
    this.recentering = false;
    this.shift = NO_SHIFT;
    this.shiftedYaw = this.shiftedPitch = 0;
    this.arm = this.zoomed = this.wanted;
  }

  update(followed: Followed, boxes: readonly PreparedBox[], dt: number): void {
    this.turnByItself(followed, dt);
    this.movePivot(followed, boxes, dt);
    this.zoomed = damp(this.zoomed, this.wanted, ZOOM_HALFLIFE, dt);
    const around = boxes.filter((box) => distanceToBox(box, ...this.pivot) < AROUND_PIVOT);
    if (around.length > 0) this.leaveBoxes(boxes, around);
    else {
      this.seekRoom(boxes, dt);
      this.stretchArm(boxes, dt);
    }
  }

  /** Looks for more room a little aside; what the user steers by, `heading`, stays. */
  private seekRoom(boxes: readonly PreparedBox[], dt: number): void {
    const limits = [MIN_PITCH, MAX_PITCH] as const;
    this.shift = this.calm()
      ? NO_SHIFT
      : roomierView(boxes, this.pivot, this.heading, this.pitch, this.zoomed, HARD_RADIUS, this.shift, limits);
    this.shiftedYaw = damp(this.shiftedYaw, this.shift.yaw, SHIFT_HALFLIFE, dt);
    this.shiftedPitch = damp(this.shiftedPitch, this.shift.pitch, SHIFT_HALFLIFE, dt);
  }

  private stretchArm(boxes: readonly PreparedBox[], dt: number): void {
    const back = backwards(this.heading + this.shiftedYaw, this.pitch + this.shiftedPitch);
    const hard = freeReach(boxes, this.pivot, back, this.zoomed, HARD_RADIUS);
    const soft = freeReach(boxes, this.pivot, back, this.zoomed, SOFT_RADIUS);
    const goal = Math.min(hard, Math.max(soft, MIN_ARM));
    this.arm = damp(this.arm, goal, goal < this.arm ? IN_HALFLIFE : OUT_HALFLIFE, dt);
    this.arm = Math.min(this.arm, hard);
    this.at = along(this.pivot, back, this.arm);
  }

  /** Without assist the avatar itself walks through boxes: then the camera takes the lowest pitch that is outside. */
  private leaveBoxes(boxes: readonly PreparedBox[], around: readonly PreparedBox[]): void {
    const others = boxes.filter((box) => !around.includes(box));
    for (let pitch = this.pitch; pitch < STEEPEST; pitch += PITCH_STEP) {
      const back = backwards(this.heading, pitch);
      const reach = freeReach(others, this.pivot, back, this.zoomed, HARD_RADIUS);
      const end = along(this.pivot, back, reach);
      this.arm = reach;
      this.at = end;
      if (distanceToBoxes(around, ...end) >= HARD_RADIUS) return;
    }
  }

  private turnByItself(followed: Followed, dt: number): void {
    if (this.recentering) {
      this.heading = dampAngle(this.heading, followed.heading, this.calm() ? 1e-6 : RECENTER_HALFLIFE, dt);
      if (Math.abs(Math.sin((this.heading - followed.heading) / 2)) < 0.005) this.recentering = false;
    } else if (this.calm()) {
      return;
    } else if (followed.trail) {
      this.heading = dampAngle(this.heading, followed.heading, 0.45, dt);
    } else {
      this.heading -= FOLLOW_RATE * followed.sideways * dt;
    }
  }

  /** The pivot follows smoothly in height only and stays out of boxes: it is the avatar's own axis, which is free. */
  private movePivot(followed: Followed, boxes: readonly PreparedBox[], dt: number): void {
    const height = this.calm() ? followed.eye : damp(this.pivot[1], followed.eye, PIVOT_HALFLIFE, dt);
    const base: Vec3 = [followed.x, followed.eye - 0.5, followed.z];
    const free = distanceToBoxes(boxes, ...base) > AROUND_PIVOT;
    const wanted = Math.max(0, height - base[1]);
    const rise = free ? freeReach(boxes, base, [0, 1, 0], wanted, HARD_RADIUS) : wanted;
    this.pivot = [followed.x, base[1] + rise, followed.z];
  }
}

function along(from: Vec3, direction: Vec3, distance: number): [number, number, number] {
  return [from[0] + direction[0] * distance, from[1] + direction[1] * distance, from[2] + direction[2] * distance];
}
