/** The page's state for tests and the curious, as `window.__app`. */

import type { App } from "./app/app";
import { POSE_FLAGS } from "./generated/messages";

/** A plain snapshot; every read takes a new one. */
export interface AppState {
  readonly connected: boolean;
  readonly connection: string;
  readonly timesOpened: number;
  readonly framesReceived: number;
  readonly framesDrawn: number;
  readonly fps: number;
  readonly root: { readonly x: number; readonly z: number; readonly heading: number } | null;
  /** Where the avatar's feet and the top of its head are in the view, CSS pixels. */
  readonly feet: readonly [number, number] | null;
  readonly head: readonly [number, number] | null;
  readonly simTime: number;
  readonly acknowledged: number;
  readonly sent: number;
  readonly scene: string | null;
  readonly avatar: string | null;
  readonly avatarTitle: string;
  readonly avatarLoaded: boolean;
  readonly avatarRevision: number;
  readonly poseRevision: number;
  readonly bodyParts: readonly string[];
  readonly capsulesReceived: number;
  readonly settings: unknown;
  readonly crossed: number;
  readonly stuck: number;
  readonly stuckNow: boolean;
  readonly blocked: unknown;
  readonly touching: boolean;
  readonly touchingParts: readonly string[];
  readonly finished: boolean;
  readonly paused: boolean;
  readonly clearance: number;
  readonly camera: readonly number[];
  readonly view: string;
  readonly cameraHeading: number;
  readonly heldKeys: number;
  readonly overlays: readonly string[];
  readonly quality: unknown;
  readonly delayMs: number;
  readonly roundTripMs: number;
  readonly replay: unknown;
  readonly going: unknown;
  readonly tour: number | null;
  readonly build: unknown;
  /** The number of the obstacle in hand; where each of those is that were pushed. */
  readonly held: number | null;
  readonly pushed: unknown;
  /** Where the middles of the obstacles are in the view, CSS pixels. */
  readonly obstaclesOnScreen: readonly (readonly [number, number])[];
  readonly steps: number;
  readonly footprints: number;
}

declare global {
  interface Window {
    readonly __app: AppState;
  }
}

/** Makes `window.__app`. */
export function exposeState(app: App): void {
  Object.defineProperty(window, "__app", { get: () => snapshot(app) });
}

function snapshot(app: App): AppState {
  const { session, picture, frames, controls } = app;
  const { pose } = frames;
  const { settings, status } = session;
  const flag = (bit: number) => ((pose?.flags ?? 0) & bit) !== 0;
  return {
    connected: session.state === "open",
    connection: session.state,
    timesOpened: session.timesOpened,
    framesReceived: session.framesReceived,
    framesDrawn: frames.drawn,
    fps: frames.stats.fps,
    root: pose && { x: pose.x, z: pose.z, heading: pose.heading },
    feet: pose && picture.onScreen([pose.x, pose.y, pose.z]),
    head: pose && picture.onScreen([pose.x, pose.y + picture.height, pose.z]),
    simTime: pose?.simTime ?? 0,
    acknowledged: session.newestPose?.acknowledged ?? 0,
    sent: controls.lastSequence,
    scene: app.live.scene?.name ?? null,
    avatar: settings?.avatar ?? null,
    avatarTitle: app.live.avatarTitle,
    avatarLoaded: picture.avatar.loaded,
    avatarRevision: picture.avatar.revision,
    poseRevision: pose?.avatarRevision ?? -1,
    bodyParts: picture.overlays.bodyParts,
    capsulesReceived: session.newestPose?.capsuleCount ?? 0,
    settings,
    crossed: status?.crossed ?? 0,
    stuck: status?.stuckTimes ?? 0,
    stuckNow: flag(POSE_FLAGS.stuck),
    blocked: status?.blocked ?? null,
    touching: flag(POSE_FLAGS.touching),
    touchingParts: picture.overlays.touching,
    finished: flag(POSE_FLAGS.finished),
    paused: flag(POSE_FLAGS.paused),
    clearance: pose?.clearance ?? Infinity,
    camera: [...picture.camera.position],
    view: picture.camera.viewName,
    cameraHeading: picture.camera.heading,
    heldKeys: controls.heldKeys,
    overlays: [...app.taste.preferences.overlays],
    quality: picture.stage.currentQuality,
    delayMs: 1000 * session.delay,
    roundTripMs: session.roundTripMs,
    replay: app.modes.replay.state,
    going: app.somewhere.last,
    tour: app.tour.at,
    build: app.modes.build.state,
    held: app.pushing.held,
    obstaclesOnScreen: picture.world.boxes.map(({ center }) => picture.onScreen(center)),
    pushed: [...app.pushing.loose.keys()].map((number) => ({ number, center: [...(picture.world.boxes[number]?.center ?? [])] })),
    steps: app.steps.count,
    footprints: app.steps.printed,
  };
}
