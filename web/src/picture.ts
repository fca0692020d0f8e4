/** Everything that is drawn: stage, scene, avatar, overlays, and the camera that sees them. */

import { Vector3, type Group } from "three";
import { AvatarView } from "./avatar/avatar_view";
import { InsetCamera } from "./camera/inset";
import type { Vec3 } from "./camera/vectors";
import { ThirdPersonCamera, type Followed } from "./camera/third_person";
import type { AvatarMessage, Plan, SceneMessage, Status } from "./generated/messages";
import type { Intent, SteeringMode } from "./input/steering";
import type { ShownPose } from "./net/pose_timeline";
import { OverlayDrawing, type Moment } from "./overlays/overlays";
import { NOTHING_LOOSE } from "./stage/loose";
import type { Theme } from "./stage/palette";
import { cheaper, fixedQuality, QualityGovernor, startingQuality, type Quality, type QualityName } from "./stage/quality";
import { Stage } from "./stage/stage";
import { World } from "./stage/world";
import { Halves } from "./stage/halves";
import { byId } from "./ui/dom";

const EYE_BELOW_HEAD = 0.06;
const DEFAULT_EYE = 1.45;
const KNEE_HEIGHT = 0.5;
const JUMP = 1;

/** What the picture needs to know besides the pose. */
export interface Scenery extends Omit<Moment, "pose" | "bodyIsAvatar"> {
  readonly status: Status | null;
  readonly intent: Intent;
  readonly steering: SteeringMode;
  /** Whether the side view is shown in a corner. */
  readonly inset: boolean;
}

/** A second run, shown in the right half of the picture. */
export interface Beside {
  readonly pose: ShownPose;
  readonly group: Group;
}

export class Picture {
  /** With a second run the picture has two halves. */
  beside: Beside | null = null;
  readonly stage: Stage;
  readonly world = new World();
  readonly avatar = new AvatarView();
  readonly camera: ThirdPersonCamera;
  readonly overlays: OverlayDrawing;
  private readonly inset = new InsetCamera();
  private readonly insetFrame = byId("inset", HTMLElement);
  private readonly governor = new QualityGovernor();
  private automatic: boolean;
  private message: AvatarMessage | null = null;
  private halves: Halves | null = null;
  private loads = 0;
  private epoch = -1;
  private last: readonly [number, number] = [Infinity, Infinity];
  /** The height of the ground under the avatar, metres. */
  floor = 0;

  constructor(
    private readonly host: HTMLElement, label: HTMLElement, quality: QualityName, private readonly calm: () => boolean,
  ) {
    this.automatic = quality === "auto";
    this.stage = new Stage(host, fixedQuality(quality === "auto" ? "high" : quality, devicePixelRatio));
    this.setQuality(quality);
    this.camera = new ThirdPersonCamera(calm);
    this.overlays = new OverlayDrawing(() => this.stage.palette, label);
    this.stage.scene.add(this.world.group, this.avatar.group, this.overlays.group);
  }

  setQuality(name: QualityName): void {
    this.automatic = name === "auto";
    const quality = this.automatic
      ? startingQuality(this.stage.rendererName, devicePixelRatio)
      : fixedQuality(name as Exclude<QualityName, "auto">, devicePixelRatio);
    this.applyQuality(quality);
  }

  setTheme(theme: Theme): void {
    this.stage.paint(theme);
    this.world.repaint(this.stage.palette, this.stage.currentQuality.rich);
    this.overlays.repaint();
  }

  /** Shows a scene, with what was pushed in it. */
  showScene(scene: SceneMessage, loose = NOTHING_LOOSE): void {
    this.world.show(scene, this.stage.palette, this.stage.currentQuality.rich);
    this.world.loosen(loose);
    this.overlays.setScene(this.world.boxes, this.world.names);
    this.last = [Infinity, Infinity];
  }

  /** Fetches the model of the place that is shown, if it has one. @throws Error when it cannot be shown */
  showModel(): Promise<void> {
    return this.world.showModel();
  }

  /** Fetches the avatar's file and shows it; the newest call wins. @throws Error when the file cannot be shown */
  async showAvatar(message: AvatarMessage): Promise<void> {
    const load = ++this.loads;
    this.message = message;
    this.overlays.setBody(message.capsules);
    if (message.url === null) {
      this.avatar.show(message, null, null);
      return;
    }
    const { loadAvatarFile, disposeAvatarFile } = await import("./avatar/avatar_file");
    const file = await loadAvatarFile(new URL(message.url, document.baseURI).href);
    if (load !== this.loads) disposeAvatarFile(file);
    else this.avatar.show(message, file, disposeAvatarFile);
  }

  /** The avatar that was asked for last. */
  get shownAvatar(): AvatarMessage | null {
    return this.message;
  }

  /** Metres from the avatar's soles to the top of its head. */
  get height(): number {
    return this.message?.height ?? DEFAULT_EYE;
  }

  setPlan(plan: Plan | null): void {
    this.overlays.setPlan(plan);
  }

  /** Draws one frame; `pose` is null before the first has come. */
  draw(pose: ShownPose | null, scenery: Scenery, dt: number): void {
    if (pose) this.place(pose, scenery, dt);
    this.world.gate.update(dt);
    const { camera } = this.stage;
    this.stage.setLift(this.camera.lift);
    camera.position.set(...this.camera.position);
    camera.lookAt(...this.camera.target);
    camera.updateMatrixWorld();
    this.overlays.seenBy(camera);
    if (pose && this.beside) this.drawHalves(pose, this.beside);
    else this.stage.render();
    this.world.drawn();
    if (pose && scenery.inset) this.drawInset(this.followed(pose, scenery), dt);
    this.overlays.placeLabels(camera, this.host.clientWidth, this.host.clientHeight);
  }

  /** Where a point of the world is in the view, in CSS pixels from its upper left corner. */
  onScreen(point: Vec3): [number, number] {
    const seen = new Vector3(...point).project(this.stage.camera);
    return [((seen.x + 1) / 2) * this.host.clientWidth, ((1 - seen.y) / 2) * this.host.clientHeight];
  }

  /** Notes how long a frame took; on `auto`, gives up some quality where that is too long. */
  measure(seconds: number): void {
    if (!this.governor.frame(seconds) || !this.automatic) return;
    const next = cheaper(this.stage.currentQuality);
    if (next) this.applyQuality(next);
  }

  private applyQuality(quality: Quality): void {
    this.stage.setQuality(quality);
    this.avatar.setRich(quality.rich);
    this.world.repaint(this.stage.palette, quality.rich);
  }

  private place(pose: ShownPose, scenery: Scenery, dt: number): void {
    this.world.move(pose.simTime);
    if (pose.avatarRevision === this.avatar.revision) this.avatar.pose(pose);
    this.avatar.update(dt, this.calm());
    const followed = this.followed(pose, scenery);
    const jumped = Math.hypot(pose.x - this.last[0], pose.z - this.last[1]) > JUMP;
    if (pose.epoch !== this.epoch && jumped) this.camera.snap(followed);
    this.epoch = pose.epoch;
    this.last = [pose.x, pose.z];
    this.floor = pose.y;
    this.world.lookUp(pose.x, pose.y, pose.z);
    this.camera.update(followed, this.world.cameraObstacles, dt);
    const knees: Vec3 = [pose.x, pose.y + KNEE_HEIGHT, pose.z];
    this.world.clearSight(this.camera.position, [this.camera.target, knees], dt);
    this.avatar.fade(this.camera.avatarOpacity);
    this.stage.follow(pose.x, pose.y, pose.z);
    this.world.follow(pose.x, pose.z);
    this.overlays.update({ ...scenery, pose, bodyIsAvatar: this.message?.drawCapsules ?? false });
  }

  /** Two runs from the same side: the avatar at the left, the second one at the right. */
  private drawHalves(pose: ShownPose, { pose: second, group }: Beside): void {
    this.halves ??= new Halves(this.stage, this.host);
    const { visible } = this.avatar.group;
    group.visible = false;
    this.halves.draw(0, [0, 0, 0]);
    this.avatar.group.visible = this.overlays.group.visible = false;
    group.visible = true;
    this.world.move(second.simTime);
    this.stage.follow(second.x, second.y, second.z);
    this.halves.draw(1, [second.x - pose.x, second.y - pose.y, second.z - pose.z]);
    this.avatar.group.visible = visible;
    this.overlays.group.visible = true;
  }

  /** The side view, where the page leaves a frame for it. */
  private drawInset(followed: Followed, dt: number): void {
    const frame = this.insetFrame.getBoundingClientRect();
    if (frame.width < 1) return;
    this.inset.update(followed, frame.width / frame.height, dt);
    this.overlays.seenBy(this.inset.camera);
    this.stage.renderInto(this.inset.camera, frame);
  }

  private followed(pose: ShownPose, { intent, steering }: Scenery): Followed {
    const eye = this.message ? this.message.height - EYE_BELOW_HEAD : DEFAULT_EYE;
    const moving = intent.forward !== 0 || intent.right !== 0 || intent.strafe !== 0;
    return {
      x: pose.x, z: pose.z, heading: pose.heading, eye: pose.y + eye, ground: pose.y,
      sideways: steering === "camera" && intent.strafe === 0 ? intent.right : 0,
      trail: steering === "tank" && moving,
    };
  }
}
