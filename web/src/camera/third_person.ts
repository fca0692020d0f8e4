/** The camera: orbits a pivot at the avatar's shoulders on a spring arm that no wall can enter, from the view that is chosen. */

import { damp, dampAngle, wrapAngle } from "./damping";
import { Glances } from "./glances";
import { backwards, NO_SHIFT, roomierView, type ViewShift } from "./roomier_view";
import { cameraReach, distanceToBoxes, pointAlong, type CameraObstacles } from "./spring_arm";
import type { Vec3 } from "./vectors";
import { VIEWS, type View, type ViewName } from "./views";

const MIN_PITCH = -0.25;
const MAX_PITCH = 1.5;
const NEAREST = 1.2;
const FARTHEST = 9;
/** A sphere of this radius round the camera never touches a box: more than the near plane's corner is away. */
const RADIUS = 0.16;
const OUT_HALFLIFE = 0.35;
const ZOOM_HALFLIFE = 0.06;
const RECENTER_HALFLIFE = 0.16;
const TRAIL_HALFLIFE = 0.45;
const SWITCH_HALFLIFE = 0.1;
const FOLLOW_RATE = 1.1;
const FADE_NEAR = 0.5;
const FADE_FAR = 1.15;
const SHIFT_HALFLIFE = 0.14;
/** Metres in sight with which one stays where the user looks from, where triangles are in the way; so many, once one has left. */
const IN_SIGHT = 1.2;
const IN_SIGHT_AGAIN = 1.8;
/** Radians: a view that is shifted by less looks along the arm. */
const STRAIGHT = 0.02;

/** Where the avatar is and what the user does with it. */
export interface Followed {
  readonly x: number;
  readonly z: number;
  readonly heading: number;
  /** Height of the eyes, metres. */
  readonly eye: number;
  /** The same on the ground: where the soles are. */
  readonly ground: number;
  /** How far the stick points sideways, -1 to 1, positive to the right. */
  readonly sideways: number;
  /** Whether the camera from behind shall come round behind the avatar by itself. */
  readonly trail: boolean;
}

/** How the user has turned and zoomed a view; `yaw` is where it looks, against the avatar's heading where the view is tied to it. */
interface Aim {
  yaw: number;
  pitch: number;
  distance: number;
}

/** What is left of a change of view. */
type Rest = Record<keyof Aim | "height" | "aside" | "lift", number>;

const NO_REST: Readonly<Rest> = { yaw: 0, pitch: 0, distance: 0, height: 0, aside: 0, lift: 0 };
const REST_KEYS = Object.keys(NO_REST) as (keyof Rest)[];

export class ThirdPersonCamera {
  private name: ViewName = "behind";
  private readonly aims = new Map<ViewName, Aim>();
  /** The avatar's heading as the camera follows it. */
  private followedHeading = 0;
  /** It fades. */
  private rest: Rest = { ...NO_REST };
  private zoomed = VIEWS.behind.distance;
  private arm = VIEWS.behind.distance;
  private shift: ViewShift = NO_SHIFT;
  private shiftedYaw = 0;
  private shiftedPitch = 0;
  private glances = new Glances();
  /** How far the last look went, along the arm, metres. */
  private seen = Infinity;
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

  get viewName(): ViewName {
    return this.name;
  }

  /** Where the camera looks, radians about +Y; the avatar's heading when it is straight behind. */
  get heading(): number {
    return this.aim.yaw + (this.view.bearing === null ? 0 : this.followedHeading);
  }

  /** By this share of its height the picture is to be shifted up. */
  get lift(): number {
    return this.view.lift + this.rest.lift;
  }

  /** Opacity of the avatar: it fades when the camera is pushed into its back. */
  get avatarOpacity(): number {
    return Math.min(1, Math.max(0, (this.arm - FADE_NEAR) / (FADE_FAR - FADE_NEAR)));
  }

  /** Goes over to another view, and finds it as it was left; the one that is free begins where the camera is. */
  show(name: ViewName): void {
    if (name === this.name) return;
    const before = { ...this.aim, yaw: this.heading };
    const { view: old, rest } = this;
    this.name = name;
    this.recentering = false;
    if (name === "orbit") this.aim.yaw = before.yaw;
    if (this.calm()) return;
    const { aim, view } = this;
    this.rest = {
      yaw: wrapAngle(before.yaw + rest.yaw - this.heading), pitch: before.pitch + rest.pitch - aim.pitch,
      distance: before.distance + rest.distance - aim.distance, height: old.height + rest.height - view.height,
      aside: old.aside + rest.aside - view.aside, lift: old.lift + rest.lift - view.lift,
    };
  }

  /** Turns by a drag, radians. */
  turn(yaw: number, pitch: number): void {
    const { aim } = this;
    aim.yaw -= yaw;
    aim.pitch = Math.min(MAX_PITCH, Math.max(MIN_PITCH, aim.pitch + pitch));
    this.recentering = false;
  }

  /** Zooms by a factor; above 1 is further away. */
  zoom(factor: number): void {
    this.aim.distance = Math.min(FARTHEST, Math.max(NEAREST, this.aim.distance * factor));
  }

  /** Asks the camera to come round to where its view is meant to be. */
  recenter(): void {
    this.recentering = true;
  }

  /** Puts the camera where its view is meant to be, at once: a new scene or a reset. */
  snap(followed: Followed): void {
    for (const name of this.aims.keys()) if (name !== "orbit") this.aims.delete(name);
    this.followedHeading = followed.heading;
    if (this.name === "behind") this.aim.yaw = followed.heading;
    this.rest = { ...NO_REST };
    this.recentering = false;
    this.shift = NO_SHIFT;
    this.shiftedYaw = this.shiftedPitch = 0;
    this.seen = Infinity;
    this.glances = new Glances();
    this.arm = this.zoomed = this.aim.distance;
  }

  update(followed: Followed, obstacles: CameraObstacles, dt: number): void {
    this.turnByItself(followed, dt);
    for (const key of REST_KEYS) this.rest[key] = damp(this.rest[key], 0, SWITCH_HALFLIFE, dt);
    const heading = this.heading + this.rest.yaw;
    const pitch = this.aim.pitch + this.rest.pitch;
    this.zoomed = damp(this.zoomed, this.aim.distance + this.rest.distance, ZOOM_HALFLIFE, dt);
    this.pivot = this.pivotFor(followed, heading, obstacles);
    this.seekRoom(obstacles, heading, pitch, dt);
    const back = backwards(heading + this.shiftedYaw, pitch + this.shiftedPitch);
    this.seen = Math.max((obstacles.sight?.(this.pivot, back, this.zoomed + RADIUS) ?? Infinity) - RADIUS, 0);
    const goal = Math.min(cameraReach(obstacles, this.pivot, back, this.zoomed, RADIUS), this.seen);
    const smooth = goal < this.arm ? goal : damp(this.arm, goal, OUT_HALFLIFE, dt);
    const free = distanceToBoxes(obstacles.all, ...pointAlong(this.pivot, back, smooth)) >= 0.9 * RADIUS;
    this.arm = free ? smooth : goal; // past furniture the camera cuts: it is never inside
    this.at = pointAlong(this.pivot, back, this.arm);
  }

  private get view(): View {
    return VIEWS[this.name];
  }

  private get aim(): Aim {
    const found = this.aims.get(this.name);
    if (found) return found;
    const { bearing, pitch, distance } = this.view;
    const fresh = { yaw: bearing ?? this.followedHeading, pitch, distance };
    this.aims.set(this.name, fresh);
    return fresh;
  }

  /** What the camera looks at: the avatar, or a point to its right as far as there is room. */
  private pivotFor({ x, z, eye, ground }: Followed, heading: number, obstacles: CameraObstacles): [number, number, number] {
    const middle: Vec3 = [x, ground + (eye - ground) * (this.view.height + this.rest.height), z];
    const aside = this.view.aside + this.rest.aside;
    if (Math.abs(aside) < 1e-3) return [...middle];
    const right: Vec3 = [-Math.cos(heading) * Math.sign(aside), 0, Math.sin(heading) * Math.sign(aside)];
    return pointAlong(middle, right, cameraReach(obstacles, middle, right, Math.abs(aside), RADIUS));
  }

  /** Looks for more room a little aside; what the user steers by, `heading`, stays. */
  private seekRoom(obstacles: CameraObstacles, heading: number, pitch: number, dt: number): void {
    const leeway = { pitch: [MIN_PITCH, MAX_PITCH], wide: this.name === "side" || this.name === "front" } as const;
    const stays = this.calm() || this.name === "orbit" || this.name === "above";
    this.shift = stays
      ? NO_SHIFT
      : roomierView(this.reachIn(obstacles, heading, pitch), pitch, this.zoomed, this.shift, leeway);
    this.shiftedYaw = damp(this.shiftedYaw, this.shift.yaw, SHIFT_HALFLIFE, dt);
    this.shiftedPitch = damp(this.shiftedPitch, this.shift.pitch, SHIFT_HALFLIFE, dt);
  }

  /** How far the camera may be from the pivot under a shift of the view. */
  private reachIn(obstacles: CameraObstacles, heading: number, pitch: number): (shift: ViewShift) => number {
    const { pivot, zoomed } = this;
    this.glances.next();
    return (shift) => {
      const back = backwards(heading + shift.yaw, pitch + shift.pitch);
      const reach = cameraReach(obstacles, pivot, back, zoomed, RADIUS);
      const look = () => (obstacles.sight?.(pivot, back, zoomed + RADIUS) ?? Infinity) - RADIUS;
      const glance = () => this.glances.at(`${shift.yaw} ${shift.pitch}`, look);
      if (shift !== NO_SHIFT) return Math.min(reach, glance());
      const straight = Math.hypot(this.shiftedYaw, this.shiftedPitch) < STRAIGHT;
      const seen = straight ? this.seen : glance();
      return seen < (this.shift === NO_SHIFT ? IN_SIGHT : IN_SIGHT_AGAIN) ? Math.min(reach, seen) : reach;
    };
  }

  private turnByItself(followed: Followed, dt: number): void {
    const { aim, view } = this;
    this.followedHeading = dampAngle(this.followedHeading, followed.heading, this.calm() ? 1e-6 : view.halflife, dt);
    if (this.recentering) this.comeRound(followed, dt);
    else if (this.name !== "behind" || this.calm()) return;
    else if (followed.trail) aim.yaw = dampAngle(aim.yaw, followed.heading, TRAIL_HALFLIFE, dt);
    else aim.yaw -= FOLLOW_RATE * followed.sideways * dt;
  }

  private comeRound(followed: Followed, dt: number): void {
    const { aim, view } = this;
    const halflife = this.calm() ? 1e-6 : RECENTER_HALFLIFE;
    const yaw = view.bearing ?? followed.heading;
    aim.yaw = dampAngle(aim.yaw, yaw, halflife, dt);
    if (view.bearing !== null) aim.pitch = damp(aim.pitch, view.pitch, halflife, dt);
    if (Math.abs(Math.sin((aim.yaw - yaw) / 2)) < 0.005) this.recentering = false;
  }
}
