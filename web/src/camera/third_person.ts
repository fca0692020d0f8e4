/** The third-person camera: orbits a pivot at the avatar's shoulders on a spring arm that no wall can enter. */

import { damp, dampAngle } from "./damping";
import { backwards, NO_SHIFT, roomierView, type ViewShift } from "./roomier_view";
import { cameraReach, distanceToBoxes, pointAlong, type CameraObstacles, type Vec3 } from "./spring_arm";

const DEFAULT_PITCH = 0.24;
const MIN_PITCH = -0.25;
const MAX_PITCH = 1.35;
const MIN_WANTED = 1.2;
const MAX_WANTED = 9;
/** A sphere of this radius round the camera never touches a box: more than the near plane's corner is away. */
const RADIUS = 0.16;
const OUT_HALFLIFE = 0.35;
const ZOOM_HALFLIFE = 0.06;
const RECENTER_HALFLIFE = 0.16;
const FOLLOW_RATE = 1.1;
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

  update(followed: Followed, obstacles: CameraObstacles, dt: number): void {
    this.turnByItself(followed, dt);
    this.pivot = [followed.x, followed.eye, followed.z];
    this.zoomed = damp(this.zoomed, this.wanted, ZOOM_HALFLIFE, dt);
    this.seekRoom(obstacles, dt);
    const back = backwards(this.heading + this.shiftedYaw, this.pitch + this.shiftedPitch);
    const goal = cameraReach(obstacles, this.pivot, back, this.zoomed, RADIUS);
    const smooth = goal < this.arm ? goal : damp(this.arm, goal, OUT_HALFLIFE, dt);
    const free = distanceToBoxes(obstacles.all, ...pointAlong(this.pivot, back, smooth)) >= 0.9 * RADIUS;
    this.arm = free ? smooth : goal; // past furniture the camera cuts: it is never inside
    this.at = pointAlong(this.pivot, back, this.arm);
  }

  /** Looks for more room a little aside; what the user steers by, `heading`, stays. */
  private seekRoom(obstacles: CameraObstacles, dt: number): void {
    const limits = [MIN_PITCH, MAX_PITCH] as const;
    this.shift = this.calm()
      ? NO_SHIFT
      : roomierView(obstacles, this.pivot, this.heading, this.pitch, this.zoomed, RADIUS, this.shift, limits);
    this.shiftedYaw = damp(this.shiftedYaw, this.shift.yaw, SHIFT_HALFLIFE, dt);
    this.shiftedPitch = damp(this.shiftedPitch, this.shift.pitch, SHIFT_HALFLIFE, dt);
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
}
