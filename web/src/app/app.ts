/** The page: brings session, picture, controls and panels together. */

import { GoingSomewhere } from "../going/going";
import { GuidedTour } from "../going/tour";
import { Controls } from "../input/controls";
import { KeyMap } from "../input/key_map";
import { PointerInput } from "../input/pointer";
import { sessionUrl } from "../net/endpoints";
import type { ShownPose } from "../net/pose_timeline";
import { Session } from "../net/session";
import { Picture } from "../picture";
import { Pushing, type PushingHost } from "../pushing/pushing";
import { oddities, readPreferences, readWishes } from "../preferences";
import { BestTimes } from "../results";
import { Steps } from "../steps/steps";
import { text } from "../texts/texts";
import { byId } from "../ui/dom";
import { listenForFiles } from "../ui/file_drop";
import { FinishCard } from "../ui/finish_card";
import { keepKeysOnView } from "../ui/focus";
import { Help } from "../ui/help";
import { Hud } from "../ui/hud";
import { KeyDialog } from "../ui/key_dialog";
import { showKeys } from "../ui/key_hints";
import { Menu, type MenuListener } from "../ui/menu";
import { Notices } from "../ui/notices";
import { StatusLine } from "../ui/status_line";
import { Veil } from "../ui/veil";
import { AddressBar } from "./address_bar";
import { Arrivals } from "./arrivals";
import { Deeds } from "./deeds";
import { Frames } from "./frames";
import { Hearing } from "./hearing";
import { LiveWalk } from "./live_walk";
import { localStore } from "./local_store";
import { Modes } from "./modes";
import { Taste } from "./taste";

export class App {
  readonly view = byId("view", HTMLElement);
  readonly picture: Picture;
  readonly session: Session;
  readonly controls: Controls;
  readonly pointer: PointerInput;
  readonly pushing: Pushing;
  readonly steps: Steps;
  readonly live: LiveWalk;
  readonly modes: Modes;
  readonly taste: Taste;
  readonly address: AddressBar;
  readonly arrivals: Arrivals;
  readonly deeds: Deeds;
  readonly frames: Frames;
  readonly somewhere: GoingSomewhere;
  readonly tour: GuidedTour;
  readonly menu: Menu;
  readonly hud = new Hud();
  readonly veil = new Veil();
  readonly notices = new Notices();
  readonly statusLine = new StatusLine();
  readonly finishCard = new FinishCard((deed) => this.deeds.goOn(deed));
  readonly best = new BestTimes(localStore());
  private readonly keys = new KeyMap(localStore());
  readonly help = new Help(this.keys);
  private keyDialog: KeyDialog | null = null;

  constructor() {
    const query = new URLSearchParams(location.search);
    const wishes = readWishes(query);
    const preferences = readPreferences(query);
    const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
    this.picture = new Picture(this.view, byId("nearest-label", HTMLElement), preferences.quality, () => calm.matches);
    this.steps = new Steps(this.picture);
    this.live = new LiveWalk(this);
    this.modes = new Modes(this);
    this.menu = new Menu(this.menuListener(), preferences);
    this.taste = new Taste(preferences, {
      picture: this.picture, menu: this.menu, repainted: () => this.modes.replay.repaint(),
      overlaysChanged: () => {
        this.subscribe();
        this.address.show();
      },
    });
    this.controls = new Controls(this.controlsHost(), byId("stick", HTMLElement), this.keys);
    this.pushing = new Pushing(this.pushingHost());
    this.pointer = new PointerInput(this.view, this.picture.camera, [this.pushing.grip, this.controls.stick]);
    this.somewhere = new GoingSomewhere(this.view, {
      picture: this.picture, send: (message) => this.session.send(message),
      say: (level, said) => this.notices.show(level, said), walks: () => this.modes.live,
    });
    this.tour = new GuidedTour({
      send: (message) => this.session.send(message), look: (view) => this.deeds.do(`view:${view}`),
      say: (level, said) => this.notices.show(level, said),
      after: (seconds, then) => {
        const timer = window.setTimeout(then, 1000 * seconds);
        return () => window.clearTimeout(timer);
      },
    });
    this.arrivals = new Arrivals(this);
    this.listen();
    this.taste.showCamera(wishes.camera);
    this.taste.setBare(!wishes.showUi);
    this.address = new AddressBar(this);
    this.frames = new Frames(this);
    this.session = new Session(sessionUrl(wishes.scene), new Hearing(this), wishes);
    this.deeds = new Deeds(this);
    this.subscribe();
    this.frames.begin();
    const odd = oddities(query);
    if (odd.length > 0) this.notices.show("warning", text("address.odd", odd.join(text("list.comma"))));
    if (query.has("replay")) this.arrivals.shownRun();
    void this.modes.buildAddress(location.hash);
    window.addEventListener("hashchange", () => void this.modes.buildAddress(location.hash)); // a link opened in this very tab
  }

  /** The pose that is shown. */
  get pose(): ShownPose | null {
    return this.frames.pose;
  }

  get stats(): Frames["stats"] {
    return this.frames.stats;
  }

  configure(change: Parameters<Session["configure"]>[0]): void {
    this.address.configure(change);
  }

  /** Asks only for the data that is drawn. */
  subscribe(): void {
    const { overlays } = this.taste.preferences;
    const assist = this.session.settings?.assist ?? true;
    this.session.subscribe({
      capsules: !assist || this.live.bodyIsAvatar || overlays.has("capsules") || overlays.has("nearest"),
      plan: overlays.has("path") || overlays.has("ghosts") || overlays.has("goal"),
    });
  }

  private listen(): void {
    keepKeysOnView(this.view);
    listenForFiles((files) => this.arrivals.take(files));
    showKeys(this.keys);
    byId("keys-open", HTMLButtonElement).addEventListener("click", () => {
      this.keyDialog ??= new KeyDialog(this.keys, () => showKeys(this.keys));
      this.keyDialog.open();
    });
  }

  private menuListener(): MenuListener {
    return {
      configure: (change) => this.configure(change),
      prefer: (change) => this.taste.prefer(change),
      overlay: (name, on) => this.taste.overlay(name, on),
      files: (files) => this.arrivals.take(files),
      menuCovers: (pixels) => {
        if (!this.modes.build.active) this.picture.stage.setCoveredRight(pixels);
      },
      action: (action) => this.deeds.do(action),
    };
  }

  private pushingHost(): PushingHost {
    return {
      view: this.view, picture: this.picture, send: (message) => this.session.send(message),
      say: (level, said) => this.notices.show(level, said), walks: () => this.modes.live, pose: () => this.pose,
      changed: () => {
        this.live.loose = this.pushing.loose;
        this.modes.noteLive();
        if (this.modes.live) this.picture.world.loosen(this.live.loose);
      },
    };
  }

  private controlsHost(): ConstructorParameters<typeof Controls>[0] {
    return {
      send: (input) => this.modes.live && this.session.send(input),
      action: (action) => this.deeds.do(action),
      look: (yaw, pitch) => this.picture.camera.turn(yaw, pitch),
      cameraHeading: () => this.picture.camera.heading,
      steering: () => this.taste.steering,
      openMenu: (open) => this.menu.showByPad(open),
      pushes: () => this.pushing.byArrows,
    };
  }
}
