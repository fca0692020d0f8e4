/** The live session as the page sees it: the server's latest words, the poses, and what to say after a reconnect. */

import {
  PROTOCOL, type AvatarMessage, type Catalog, type ClientMessage, type ClipMessage, type Configure, type Crossed, type Going, type Hello,
  type Loading, type Notice, type Plan, type PoseFrame, type Pushed, type SceneMessage, type ServerMessage, type Settings, type Status,
} from "../generated/messages";
import type { SessionWishes } from "../preferences";
import { LeastClearance } from "../results";
import { Connection, type ConnectionState } from "./connection";
import { PoseTimeline, type ShownPose } from "./pose_timeline";
import { ServerClock } from "./server_clock";
import { heard } from "../texts/sayings";
import { worded } from "../texts/worded";

/** Who is told what the server says. */
export interface SessionListener {
  /** @param why the reason of a lost line */
  connection(state: ConnectionState, why: string): void;
  catalog(catalog: Catalog): void;
  settings(settings: Settings): void;
  scene(scene: SceneMessage): void;
  avatar(avatar: AvatarMessage): void;
  clip(clip: ClipMessage): void;
  status(status: Status): void;
  /** A pose has come; it is shown a little later. */
  frameCame(frame: PoseFrame): void;
  plan(plan: Plan): void;
  /** The server does not offer the chosen avatar (any more); false to ask for it all the same: someone has shared it. */
  avatarLost(id: string): boolean;
  loading(loading: Loading): void;
  crossed(crossed: Crossed): void;
  going(going: Going): void;
  pushed(pushed: Pushed): void;
  notice(level: Notice["level"], message: string): void;
}

/** Extra data that the page wants in the stream. */
export interface Subscriptions {
  readonly capsules: boolean;
  readonly plan: boolean;
}

export class Session {
  state: ConnectionState = "connecting";
  settings: Settings | null = null;
  status: Status | null = null;
  framesReceived = 0;
  timesOpened = 0;
  /** On the way since the start. */
  readonly leastClearance = new LeastClearance();
  private start: readonly [number, number] = [0, 0];
  private readonly timeline = new PoseTimeline();
  private readonly clock = new ServerClock();
  private readonly connection: Connection;
  private subscriptions: Subscriptions = { capsules: false, plan: false };
  /** The next settings tell what came of the scene that was asked for. */
  private decided = false;
  private choices: Omit<Configure, "type">;

  constructor(url: string, private readonly listener: SessionListener, wishes: SessionWishes) {
    const { scene, avatar, planner, queueSize, assist, walkSpeed, style } = wishes;
    this.choices = { scene, avatar, planner, queueSize, assist, walkSpeed, style };
    this.connection = new Connection(url, {
      pose: (frame) => this.receivePose(frame),
      message: (message) => this.receive(message),
      state: (state, why) => this.changeState(state, why),
    });
  }

  get roundTripMs(): number {
    return this.connection.roundTripMs;
  }

  /** Seconds by which the picture stays behind the newest pose. */
  get delay(): number {
    return this.clock.delay;
  }

  get newestPose(): PoseFrame | null {
    return this.timeline.newest;
  }

  /** Whether the scene that was asked for is still on its way: the settings tell the one before. */
  get sceneAwaited(): boolean {
    const { scene } = this.choices;
    return (scene ?? this.settings?.scene) !== this.settings?.scene;
  }

  send(message: ClientMessage): void {
    this.connection.send(message);
  }

  /** Changes settings, and keeps them for the next connection. */
  configure(change: Omit<Configure, "type">): void {
    this.choices = { ...this.choices, ...change };
    this.send({ type: "configure", ...change });
  }

  subscribe(wanted: Subscriptions): void {
    if (wanted.capsules === this.subscriptions.capsules && wanted.plan === this.subscriptions.plan) return;
    this.subscriptions = wanted;
    this.send({ type: "overlays", ...wanted });
  }

  /** The pose to show now (`localTime` in seconds); null before the first. */
  poseAt(localTime: number): ShownPose | null {
    return this.timeline.sample(this.clock.now(localTime));
  }

  private changeState(state: ConnectionState, why: string): void {
    this.state = state;
    if (state === "open") this.timesOpened++;
    if (state === "lost") {
      this.timeline.clear();
      this.clock.reset();
    }
    this.listener.connection(state, why);
  }

  private receivePose(frame: PoseFrame): void {
    this.framesReceived++;
    this.leastClearance.add(frame, this.start);
    this.clock.arrived(frame.time, performance.now() / 1000);
    this.timeline.push(frame);
    this.listener.frameCame(frame);
  }

  /** Asks a new connection for what the last one had; an avatar that the server has lost is left out. */
  private greet({ protocol, catalog }: Hello): void {
    const { avatar } = this.choices;
    const offered = catalog.avatars.some((known) => known.id === avatar);
    if (avatar && !offered && this.listener.avatarLost(avatar)) this.choices = { ...this.choices, avatar: null };
    const { clip } = this.choices;
    if (clip && !catalog.clips.some((known) => known.id === clip)) this.choices = { ...this.choices, clip: "" };
    if (protocol !== PROTOCOL) {
      this.listener.notice("error", worded("This page and its server are of different versions: reload the page."));
    }
    if (Object.values(this.choices).some((choice) => choice !== null)) this.send({ type: "configure", ...this.choices });
    this.send({ type: "overlays", ...this.subscriptions });
    if (this.settings) this.send({ type: "clock", paused: this.settings.paused, speed: this.settings.speed });
  }

  private receive(message: ServerMessage): void {
    const { listener } = this;
    switch (message.type) {
      case "hello":
        this.greet(message);
        listener.catalog(message.catalog);
        break;
      case "settings":
        this.settings = message;
        if (this.decided) this.choices = { ...this.choices, scene: message.scene };
        this.decided = false;
        listener.settings(message);
        break;
      case "status":
        this.status = message;
        listener.status(message);
        break;
      case "scene":
        this.start = [message.start.x, message.start.z];
        listener.scene(message);
        break;
      case "avatar":
        listener.avatar(message);
        break;
      case "clip":
        listener.clip(message);
        break;
      case "plan":
        listener.plan(message);
        break;
      case "loading":
        this.decided ||= message.what === "scene" && !message.active;
        listener.loading(message);
        break;
      case "crossed":
        listener.crossed(message);
        break;
      case "going":
        listener.going(message);
        break;
      case "pushed":
        listener.pushed(message);
        break;
      case "notice":
        this.decided ||= message.level === "error";
        listener.notice(message.level, heard(message.message));
        break;
      case "pong":
        break;
    }
  }
}
