/** What the server says, and what the page does about it. */

import type {
  AvatarMessage, Catalog, ClipMessage, Crossed, Going, Loading, Notice, Plan, PoseFrame, Pushed, SceneMessage, Settings, Status,
} from "../generated/messages";
import type { GoingSomewhere } from "../going/going";
import type { GuidedTour } from "../going/tour";
import type { Controls } from "../input/controls";
import type { ConnectionState } from "../net/connection";
import type { Session, SessionListener } from "../net/session";
import type { Picture } from "../picture";
import type { Pushing } from "../pushing/pushing";
import type { BestTimes } from "../results";
import { showAvatarAbout } from "../ui/avatar_about";
import { byId } from "../ui/dom";
import type { FinishCard } from "../ui/finish_card";
import type { Hud } from "../ui/hud";
import type { Menu } from "../ui/menu";
import type { Notices } from "../ui/notices";
import type { StatusLine } from "../ui/status_line";
import type { Veil } from "../ui/veil";
import type { AddressBar } from "./address_bar";
import type { Arrivals } from "./arrivals";
import type { Frames } from "./frames";
import type { LiveWalk } from "./live_walk";
import type { Modes } from "./modes";
import type { Subscription } from "./subscription";
import type { Taste } from "./taste";
import { sceneTitle } from "../texts/scene_titles";

export interface HearingParts {
  readonly session: Session;
  readonly picture: Picture;
  readonly controls: Controls;
  readonly taste: Taste;
  readonly modes: Modes;
  readonly live: LiveWalk;
  readonly address: AddressBar;
  readonly arrivals: Arrivals;
  readonly somewhere: GoingSomewhere;
  readonly tour: GuidedTour;
  readonly pushing: Pushing;
  readonly menu: Menu;
  readonly hud: Hud;
  readonly veil: Veil;
  readonly notices: Notices;
  readonly statusLine: StatusLine;
  readonly finishCard: FinishCard;
  readonly best: BestTimes;
  readonly frames: Frames;
  readonly subscription: Subscription;
}

export class Hearing implements SessionListener {
  constructor(private readonly parts: HearingParts) {}

  connection(state: ConnectionState, why: string): void {
    this.parts.veil.connection(state, why);
    if (state !== "open") return;
    this.parts.controls.repeat();
    this.parts.modes.build.serverBack();
  }

  catalog(catalog: Catalog): void {
    this.parts.menu.showCatalog(catalog);
  }

  settings(settings: Settings): void {
    this.parts.menu.showSettings(settings);
    this.parts.modes.noteLive();
    this.parts.subscription.renew();
    this.parts.address.show();
  }

  scene(scene: SceneMessage): void {
    const { live, modes, pushing, somewhere, tour, statusLine, finishCard, menu } = this.parts;
    live.scene = scene;
    pushing.enter(scene);
    live.loose = pushing.loose;
    modes.noteLive();
    somewhere.forget();
    tour.end();
    menu.offerTour(scene.tour.length > 0);
    if (modes.live) live.furnish();
    statusLine.restart();
    finishCard.hide();
    const title = sceneTitle(scene.title);
    menu.addScene(scene.name, title);
    byId("place", HTMLElement).textContent = title;
    document.title = `${title} · Elbowroom`;
  }

  avatar(message: AvatarMessage): void {
    const { live, modes, menu } = this.parts;
    live.avatar = message;
    modes.noteLive();
    showAvatarAbout(message);
    menu.addAvatar(message.id, message.title);
    this.parts.subscription.renew();
    if (!modes.replay.active) live.dress();
  }

  pushed(pushed: Pushed): void {
    this.parts.pushing.heard(pushed);
  }

  frameCame(frame: PoseFrame): void {
    this.parts.pushing.frameCame(frame);
    this.parts.modes.replay.keep(frame);
  }

  clip(message: ClipMessage): void {
    this.parts.menu.clips.show(message);
  }

  avatarLost(id: string): boolean {
    return this.parts.arrivals.avatarLost(id);
  }

  status(status: Status): void {
    const { picture, session, frames: { stats, pose }, hud, taste } = this.parts;
    picture.world.markBlocking(status.blocked?.obstacles ?? []);
    const page = {
      fps: stats.fps, frameMsP50: stats.percentileMs(0.5), frameMsP95: stats.percentileMs(0.95),
      roundTripMs: session.roundTripMs, clearance: pose?.clearance ?? Infinity,
      planner: session.settings?.planner ?? "",
    };
    hud.update(status, page, taste.preferences.overlays.has("plan"));
  }

  plan(plan: Plan): void {
    this.parts.picture.setPlan(plan);
  }

  loading(loading: Loading): void {
    this.parts.veil.loading(loading);
  }

  crossed(crossed: Crossed): void {
    const { session, statusLine, best, live, finishCard, picture } = this.parts;
    statusLine.crossed(crossed, performance.now() / 1000);
    const { assist = true, planner = "" } = session.settings ?? {};
    const bestTime = assist ? best.note(live.scene?.name ?? "", planner, crossed.seconds) : null;
    finishCard.show({ crossed, clearance: session.leastClearance.value, assist, best: bestTime });
    picture.world.gate.flash();
  }

  going(going: Going): void {
    this.parts.somewhere.heard(going);
    this.parts.tour.heard(going);
  }

  notice(level: Notice["level"], message: string): void {
    this.parts.notices.show(level, message);
  }
}
