/** The page: brings session, picture, controls and panels together, a frame at a time. */

import { AddressLine, isPrivate, withOwnAvatar } from "./address";
import { uploadFile } from "./avatar/upload";
import { nextView, viewNamed, type ViewName } from "./camera/views";
import { BuildDoor } from "./builder/door";
import { FrameStats } from "./frame_stats";
import { GoingSomewhere } from "./going/going";
import { POSE_FLAGS } from "./generated/messages";
import type { AvatarMessage, Catalog, ClipMessage, Crossed, Going, Loading, Notice, Plan, PoseFrame, SceneMessage, Settings, Status, Uploaded } from "./generated/messages";
import { Controls } from "./input/controls";
import { KeyMap } from "./input/key_map";
import type { Action } from "./input/keyboard";
import { PointerInput } from "./input/pointer";
import { NO_INTENT, type SteeringMode } from "./input/steering";
import type { ConnectionState } from "./net/connection";
import { sessionUrl } from "./net/endpoints";
import type { ShownPose } from "./net/pose_timeline";
import { Session, type SessionListener } from "./net/session";
import { OVERLAYS, parseOverlays, type OverlayName } from "./overlays/overlay_names";
import { Picture } from "./picture";
import { ReplayDoor } from "./replay/door";
import { addressWithoutLanguage, readPreferences, readWishes, storePreferences, type Preferences } from "./preferences";
import { BestTimes, nextScene } from "./results";
import { text } from "./texts/texts";
import { showAvatarAbout } from "./ui/avatar_about";
import { byId } from "./ui/dom";
import { listenForFiles } from "./ui/file_drop";
import { keepKeysOnView } from "./ui/focus";
import { FinishCard, type FinishDeed } from "./ui/finish_card";
import { KeyDialog } from "./ui/key_dialog";
import { showKeys } from "./ui/key_hints";
import { Help } from "./ui/help";
import { Hud } from "./ui/hud";
import { Menu, type MenuListener } from "./ui/menu";
import { Notices } from "./ui/notices";
import { shareAddress } from "./ui/share";
import { Steps } from "./steps/steps";
import { StatusLine } from "./ui/status_line";
import { Veil } from "./ui/veil";

type Deed = Exclude<Action, `view:${string}`>;

const LONGEST_FRAME = 0.1;
const SLOW_MOTION = 0.25;
const DEFAULT_OVERLAYS: readonly OverlayName[] = ["path", "ghosts", "nearest"];

export class App implements SessionListener, MenuListener {
  readonly preferences: Preferences;
  readonly session: Session;
  readonly picture: Picture;
  readonly controls: Controls;
  readonly stats = new FrameStats();
  readonly replay: ReplayDoor;
  readonly build: BuildDoor;
  readonly steps: Steps;
  readonly somewhere: GoingSomewhere;
  pose: ShownPose | null = null;
  sceneMessage: SceneMessage | null = null;
  private avatarMessage: AvatarMessage | null = null;
  /** The replay has paused the live walk. */
  private held = false;
  avatarTitle = "";
  framesDrawn = 0;
  private bodyIsAvatar = false;
  /** Kept to send it again when the server has lost it. */
  private lastFile: File | null = null;
  private readonly address: AddressLine;
  private readonly menu: Menu;
  private readonly pointer: PointerInput;
  private readonly hud = new Hud();
  private readonly keys = new KeyMap(localStore());
  private readonly help = new Help(this.keys);
  private keyDialog: KeyDialog | null = null;
  private readonly finishCard = new FinishCard((deed) => this.goOn(deed));
  private readonly best = new BestTimes(localStore());
  private readonly notices = new Notices();
  private readonly statusLine = new StatusLine();
  private readonly veil = new Veil();
  private readonly view = byId("view", HTMLElement);
  private readonly calm = window.matchMedia("(prefers-reduced-motion: reduce)");
  private readonly dark = window.matchMedia("(prefers-color-scheme: dark)");
  private lastOverlays: readonly OverlayName[] = DEFAULT_OVERLAYS;
  private lastFrame = performance.now() / 1000;

  constructor() {
    const query = new URLSearchParams(location.search);
    const wishes = readWishes(query);
    this.preferences = readPreferences(query);
    const label = byId("nearest-label", HTMLElement);
    this.picture = new Picture(this.view, label, this.preferences.quality, () => this.calm.matches);
    this.steps = new Steps(this.picture);
    this.replay = new ReplayDoor({
      picture: this.picture, say: (level, said) => this.notices.show(level, said), closed: () => this.goOnLive(),
      dock: (pixels) => document.documentElement.style.setProperty("--dock", `${pixels}px`),
    });
    this.build = new BuildDoor({
      picture: this.picture, avatar: () => this.session.settings?.avatar ?? "", say: (level, said) => this.notices.show(level, said),
      dock: (bottom, right) => this.leaveRoom(bottom, right), closed: () => this.goOnLive(),
      walkIn: ({ name, title }) => {
        this.menu.addScene(name, title);
        this.configure({ scene: name });
      },
    });
    this.applyTheme();
    this.dark.addEventListener("change", () => this.applyTheme());
    this.menu = new Menu(this, this.preferences);
    this.controls = new Controls(this.controlsHost(), byId("stick", HTMLElement), this.keys);
    this.pointer = new PointerInput(this.view, this.picture.camera, this.controls.stick);
    this.somewhere = new GoingSomewhere(this.view, {
      picture: this.picture, send: (message) => this.session.send(message),
      say: (level, said) => this.notices.show(level, said), walks: () => !this.replay.active && !this.build.active,
    });
    keepKeysOnView(this.view);
    listenForFiles((file) => this.file(file));
    showKeys(this.keys);
    byId("keys-open", HTMLButtonElement).addEventListener("click", () => {
      this.keyDialog ??= new KeyDialog(this.keys, () => showKeys(this.keys));
      this.keyDialog.open();
    });
    this.showPanels();
    this.picture.camera.show(wishes.camera);
    this.menu.showView(wishes.camera);
    this.setBare(!wishes.showUi);
    this.address = new AddressLine((query) => this.goTo(query));
    this.session = new Session(sessionUrl(), this, wishes);
    this.subscribe();
    requestAnimationFrame(() => this.frame());
    if (query.has("replay")) void this.replayRun(null);
    void this.build.showAddress(location.hash).then((shown) => shown && this.beginBuilding());
  }

  // What the server says.

  connection(state: ConnectionState, why: string): void {
    this.veil.connection(state, why);
    if (state === "open") this.controls.repeat();
  }

  catalog(catalog: Catalog): void {
    this.menu.showCatalog(catalog);
  }

  settings(settings: Settings): void {
    this.menu.showSettings(settings);
    this.noteLive();
    this.subscribe();
    this.showAddress();
  }

  scene(scene: SceneMessage): void {
    this.sceneMessage = scene;
    this.noteLive();
    this.somewhere.forget();
    if (!this.replay.active && !this.build.active) this.furnish(scene);
    this.statusLine.restart();
    this.finishCard.hide();
    this.menu.addScene(scene.name, scene.title);
    byId("place", HTMLElement).textContent = scene.title;
    document.title = `${scene.title} · Elbowroom`;
  }

  avatar(message: AvatarMessage): void {
    this.avatarMessage = message;
    this.noteLive();
    this.bodyIsAvatar = message.drawCapsules;
    showAvatarAbout(message);
    this.menu.addAvatar(message.id, message.title);
    this.subscribe();
    if (!this.replay.active) this.dress(message);
  }

  private furnish(scene: SceneMessage): void {
    this.picture.showScene(scene);
    if (scene.model) this.veil.download(true);
    this.picture
      .showModel()
      .catch((error: unknown) => this.notices.show("error", `${scene.title} cannot be shown: ${words(error)}`))
      .finally(() => scene.model && this.veil.download(false));
  }

  private dress(message: AvatarMessage): void {
    this.veil.download(true);
    this.picture
      .showAvatar(message)
      .then(() => (this.avatarTitle = message.title))
      .catch((error: unknown) => this.notices.show("error", text("app.noAvatar", message.title, words(error))))
      .finally(() => this.veil.download(false));
  }

  frameCame(frame: PoseFrame): void {
    this.replay.keep(frame);
  }

  clip(message: ClipMessage): void {
    this.menu.clips.show(message);
  }

  avatarLost(id: string): boolean {
    if (this.lastFile) this.file(this.lastFile);
    else if (isPrivate(id)) return false;
    else this.notices.show("warning", text("app.standIn", id));
    return true;
  }

  status(status: Status): void {
    this.picture.world.markBlocking(status.blocked?.obstacles ?? []);
    const { stats } = this;
    const page = {
      fps: stats.fps, frameMsP50: stats.percentileMs(0.5), frameMsP95: stats.percentileMs(0.95),
      roundTripMs: this.session.roundTripMs, clearance: this.pose?.clearance ?? Infinity,
      planner: this.session.settings?.planner ?? "",
    };
    this.hud.update(status, page, this.preferences.overlays.has("plan"));
  }

  plan(plan: Plan): void {
    this.picture.setPlan(plan);
  }

  loading(loading: Loading): void {
    this.veil.loading(loading);
  }

  crossed(crossed: Crossed): void {
    this.statusLine.crossed(crossed, performance.now() / 1000);
    const { assist = true, planner = "" } = this.session.settings ?? {};
    const best = assist ? this.best.note(this.sceneMessage?.name ?? "", planner, crossed.seconds) : null;
    this.finishCard.show({ crossed, clearance: this.session.leastClearance.value, assist, best });
    this.picture.world.gate.flash();
  }

  going(going: Going): void {
    this.somewhere.heard(going);
  }

  notice(level: Notice["level"], message: string): void {
    this.notices.show(level, message);
  }

  // What the user does.

  configure(change: Parameters<Session["configure"]>[0]): void {
    this.address.choose();
    this.session.configure(change);
  }

  /** Goes to the place that an address names: the back button leads there. */
  private goTo(query: URLSearchParams): void {
    const { scene, avatar, planner, queueSize, walkSpeed, camera, assist } = readWishes(query);
    this.session.configure({ scene, avatar, planner, queueSize, walkSpeed, assist: assist ?? true });
    this.preferences.overlays = parseOverlays(query.get("overlays"));
    this.picture.camera.show(camera);
    this.menu.showView(camera);
    this.overlaysChanged();
  }

  private showAddress(): void {
    const { settings } = this.session;
    const { overlays } = this.preferences;
    if (settings && !this.session.sceneAwaited) this.address.show({ settings, camera: this.picture.camera.viewName, overlays });
  }

  private share(): void {
    const avatar = this.session.settings?.avatar ?? "";
    void shareAddress(document.title, withOwnAvatar(location.href, avatar), isPrivate(avatar)).then((said) => said && this.notices.show("info", said));
  }

  prefer(change: Partial<Preferences>): void {
    Object.assign(this.preferences, change);
    for (const name of ["steering", "quality", "theme"] as const) this.menu.showPreference(name, this.preferences[name]);
    this.showPanels();
    if (change.theme) this.applyTheme();
    if (change.quality) this.picture.setQuality(change.quality);
    storePreferences(this.preferences);
    if (change.language) location.replace(addressWithoutLanguage(location.href));
  }

  overlay(name: OverlayName, on: boolean): void {
    if (on) this.preferences.overlays.add(name);
    else this.preferences.overlays.delete(name);
    this.overlaysChanged();
  }

  file(file: File): void {
    if (/\.elbow$/i.test(file.name)) {
      void this.replayRun(file);
      return;
    }
    if (/\.json$/i.test(file.name)) {
      void file.text().then((scene) => this.build.showText(scene)).then(() => this.beginBuilding());
      return;
    }
    this.lastFile = file;
    this.veil.upload(file.name);
    uploadFile(file)
      .then((uploaded) => this.use(uploaded))
      .catch((error: unknown) => {
        this.lastFile = null;
        this.notices.show("error", words(error));
      })
      .finally(() => this.veil.upload(null));
  }

  /** An avatar is put on, a motion is played, a place is gone to; the motions of an avatar's own file wait in the menu. */
  private use({ avatar, clips, scene }: Uploaded): void {
    if (scene) {
      this.lastFile = null;
      this.menu.addScene(scene.name, scene.title);
      this.configure({ scene: scene.name });
    }
    this.menu.clips.add(clips);
    if (avatar) {
      this.menu.addAvatar(avatar.id, avatar.title);
      this.configure({ avatar: avatar.id });
      const brought = text(clips.length === 1 ? "app.oneClip" : "app.clips", avatar.title, clips.length);
      if (clips.length > 0) this.notices.show("info", brought);
    } else if (clips[0]) {
      this.lastFile = null;
      this.configure({ clip: clips[0].id });
    }
  }

  menuCovers(pixels: number): void {
    if (!this.build?.active) this.picture.stage.setCoveredRight(pixels);
  }

  action(action: Action): void {
    if (this.replay.answers(action) || this.build.answers(action)) return;
    if (action.startsWith("view:")) this.showView(viewNamed(action.slice("view:".length)));
    else this.actions[action as Deed]();
  }

  // Each action by its name; the keyboard, the gamepad and the bar share them.
  private readonly actions: Readonly<Record<Deed, () => void>> = {
    reset: () => {
      this.statusLine.restart();
      this.finishCard.hide();
      this.somewhere.forget();
      this.session.send({ type: "reset" });
    },
    pause: () => this.session.send({ type: "clock", paused: !this.session.settings?.paused }),
    step: () => this.session.send({ type: "clock", steps: 1 }),
    slow: () => this.session.send({ type: "clock", speed: (this.session.settings?.speed ?? 1) < 1 ? 1 : SLOW_MOTION }),
    assist: () => this.session.configure({ assist: !(this.session.settings?.assist ?? true) }),
    cameraMode: () => this.prefer({ steering: this.preferences.steering === "camera" ? "tank" : "camera" }),
    recenter: () => this.picture.camera.recenter(),
    pointerLock: () => this.pointer.toggleLock(),
    overlays: () => this.toggleAllOverlays(),
    hideUi: () => this.setBare(!document.body.classList.contains("bare")),
    menu: () => this.menu.setOpen(!this.menu.isOpen),
    nextView: () => this.showView(nextView(this.picture.camera.viewName)),
    inset: () => this.prefer({ inset: !this.preferences.inset }),
    share: () => this.share(),
    stepBack: () => undefined,
    replay: () => void this.openReplay(),
    build: () => void this.build.toggle(this.sceneMessage).then(() => this.beginBuilding()),
    help: () => this.help.toggle(),
    escape: () => {
      this.finishCard.hide();
      this.setBare(false);
      this.view.focus();
    },
  };

  private noteLive(): void {
    this.replay.live(this.sceneMessage, this.avatarMessage, this.session.settings);
  }

  /** The live walk waits while a run is replayed. */
  private async openReplay(): Promise<void> {
    await this.replay.toggle();
    if (!this.replay.active) return;
    this.menu.setOpen(false);
    this.hold();
  }

  /** The live walk waits while one builds. */
  private beginBuilding(): void {
    if (!this.build.active) return;
    this.menu.setOpen(false);
    this.finishCard.hide();
    this.hold();
  }

  /** Leaves room for a panel at the bottom or at the right. */
  private leaveRoom(bottom: number, right: number): void {
    document.documentElement.style.setProperty("--dock", `${bottom}px`);
    this.picture.stage.setCoveredRight(right);
  }

  /** Shows a recording: a file, or the one that the server was started with. */
  private async replayRun(file: File | null): Promise<void> {
    this.veil.upload(file?.name ?? "…");
    try {
      await this.replay.showRun(file);
      this.menu.setOpen(false);
      this.hold();
    } catch (error) {
      this.notices.show("error", words(error));
    } finally {
      this.veil.upload(null);
    }
  }

  private hold(): void {
    if (this.held || this.session.settings?.paused) return;
    this.held = true;
    this.session.send({ type: "clock", paused: true });
  }

  /** The replay is closed: the live walk is shown again and goes on. */
  private goOnLive(): void {
    if (this.sceneMessage) this.furnish(this.sceneMessage);
    if (this.avatarMessage && this.picture.shownAvatar !== this.avatarMessage) this.dress(this.avatarMessage);
    if (this.held) this.session.send({ type: "clock", paused: false });
    this.held = false;
    this.controls.repeat();
    this.view.focus();
  }

  /** After the finish. */
  private goOn(deed: FinishDeed): void {
    const { scene, assist } = this.session.settings ?? {};
    if (deed === "replay") {
      this.action("replay");
      return;
    }
    if (deed === "next" && scene) {
      this.configure({ scene: nextScene(scene, this.menu.offered) });
      return;
    }
    if (deed === "compare") this.configure({ assist: !assist });
    this.action("reset");
  }

  private controlsHost(): ConstructorParameters<typeof Controls>[0] {
    return {
      send: (input) => !this.replay.active && !this.build.active && this.session.send(input),
      action: (action) => this.action(action),
      look: (yaw, pitch) => this.picture.camera.turn(yaw, pitch),
      cameraHeading: () => this.picture.camera.heading,
      steering: () => this.steering,
    };
  }

  /** Hides or shows all panels. */
  private setBare(bare: boolean): void {
    document.body.classList.toggle("bare", bare);
    this.menu.setOpen(this.menu.isOpen);
  }

  private showPanels(): void {
    this.menu.showPanels(this.preferences);
    byId("hud", HTMLElement).hidden = !this.preferences.hud;
    byId("inset", HTMLElement).hidden = !this.preferences.inset;
  }

  private showView(name: ViewName): void {
    this.picture.camera.show(name);
    this.menu.showView(name);
    this.showAddress();
  }

  /** From behind as the user prefers it; all other cameras show the avatar walk the way it faces. */
  private get steering(): SteeringMode {
    return this.picture.camera.viewName === "behind" ? this.preferences.steering : "tank";
  }

  private toggleAllOverlays(): void {
    const { overlays } = this.preferences;
    const shown = OVERLAYS.filter((name) => overlays.has(name));
    if (shown.length > 0) this.lastOverlays = shown;
    overlays.clear();
    if (shown.length === 0) for (const name of this.lastOverlays) overlays.add(name);
    this.overlaysChanged();
  }

  private overlaysChanged(): void {
    this.menu.showOverlays(this.preferences.overlays);
    storePreferences(this.preferences);
    this.subscribe();
    this.showAddress();
  }

  /** Asks only for the data that is drawn. */
  private subscribe(): void {
    const { overlays } = this.preferences;
    const assist = this.session.settings?.assist ?? true;
    this.session.subscribe({
      capsules: !assist || this.bodyIsAvatar || overlays.has("capsules") || overlays.has("nearest"),
      plan: overlays.has("path") || overlays.has("ghosts") || overlays.has("goal"),
    });
  }

  private applyTheme(): void {
    const { theme } = this.preferences;
    const shown = theme === "auto" ? (this.dark.matches ? "dark" : "light") : theme;
    document.documentElement.dataset["theme"] = shown;
    document.querySelector('meta[name="theme-color"]')?.setAttribute("content", shown === "dark" ? "#2a3546" : "#e6e5df");
    this.picture.setTheme(shown);
    this.replay.repaint();
  }

  private frame(): void {
    requestAnimationFrame(() => this.frame());
    const now = performance.now() / 1000;
    const elapsed = now - this.lastFrame;
    this.lastFrame = now;
    this.stats.add(elapsed);
    this.picture.measure(elapsed);
    const dt = Math.min(elapsed, LONGEST_FRAME);
    this.controls.update(dt);
    const replayed = this.replay.advance(dt);
    this.pose = replayed ?? this.session.poseAt(now) ?? this.pose;
    const { settings, status } = this.session;
    if (this.pose) this.steps.update(this.pose, { heard: this.preferences.sound, shown: this.preferences.overlays.has("footprints") });
    if (replayed) {
      this.drawReplayed(replayed, dt);
      return;
    }
    const { intent } = this.controls;
    if (intent.forward !== 0 || intent.right !== 0 || intent.strafe !== 0) this.statusLine.moved();
    this.statusLine.update(this.pose, status, settings, now);
    this.picture.draw(this.pose, {
      status, intent, steering: this.steering, shown: this.preferences.overlays,
      inset: this.preferences.inset && !document.body.classList.contains("bare"),
      markTouching: settings?.assist === false,
    }, dt);
    this.framesDrawn++;
  }

  private drawReplayed(pose: ShownPose, dt: number): void {
    const shown = new Set(OVERLAYS.filter((name) => name === "capsules" && this.preferences.overlays.has(name)));
    this.picture.draw(pose, {
      status: null, intent: NO_INTENT, steering: "tank", shown,
      inset: this.preferences.inset && !document.body.classList.contains("bare"),
      markTouching: (pose.flags & POSE_FLAGS.assist) === 0,
    }, dt);
    this.framesDrawn++;
  }
}

function localStore(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}

function words(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
