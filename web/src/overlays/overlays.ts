/** Draws what the planner knows: the collision body, the way ahead, ghosts, postures and the nearest distance. */

import { Group, Vector3, type PerspectiveCamera } from "three";
import type { PreparedBox } from "../camera/spring_arm";
import type { AvatarCapsule, Plan, Status } from "../generated/messages";
import type { ShownPose } from "../net/pose_timeline";
import type { Palette } from "../stage/palette";
import { CapsuleSet } from "./capsule_set";
import { ghostShare } from "./ghost_share";
import { NearestLine } from "./nearest_line";
import type { OverlayName } from "./overlay_names";
import { PathRibbon } from "./path_ribbon";
import { capsuleTouches } from "./touching";

const MOST_GHOSTS = 9;
const BREAST = 1.1;

interface Drawings {
  readonly body: CapsuleSet;
  readonly solidBody: CapsuleSet;
  readonly touching: CapsuleSet;
  readonly ghosts: CapsuleSet;
  readonly goal: CapsuleSet;
  readonly chosen: CapsuleSet;
  readonly path: PathRibbon;
  readonly nearest: NearestLine;
}

/** What the overlays need to know about the moment. */
export interface Moment {
  readonly pose: ShownPose;
  readonly status: Status | null;
  readonly shown: ReadonlySet<OverlayName>;
  /** The canned walk plays: parts inside obstacles are marked. */
  readonly markTouching: boolean;
  /** There is no avatar file: the capsules are the avatar. */
  readonly bodyIsAvatar: boolean;
}

export class OverlayDrawing {
  readonly group = new Group();
  private capsules: readonly AvatarCapsule[] = [];
  private boxes: readonly PreparedBox[] = [];
  private boxNames: readonly string[] = [];
  private drawings: Drawings;
  private plan: Plan | null = null;
  private planShown: string | null = null;
  private touchingNames: readonly string[] = [];
  private readonly avatarAt = new Vector3();

  constructor(private readonly palette: () => Palette, private readonly label: HTMLElement) {
    this.drawings = this.create(0);
  }

  /** Names of the capsules that are inside an obstacle in the picture. */
  get touching(): readonly string[] {
    return this.touchingNames;
  }

  /** Names of all capsules. */
  get bodyParts(): readonly string[] {
    return this.capsules.map((capsule) => capsule.name);
  }

  setScene(boxes: readonly PreparedBox[], names: readonly string[]): void {
    this.boxes = boxes;
    this.boxNames = names;
    this.setPlan(null);
  }

  setBody(capsules: readonly AvatarCapsule[]): void {
    this.capsules = capsules;
    this.setPlan(null);
    this.repaint();
  }

  setPlan(plan: Plan | null): void {
    this.plan = plan;
    this.planShown = null;
  }

  /** Makes everything anew: after a change of colours or of the body. */
  repaint(): void {
    for (const drawing of Object.values(this.drawings) as Drawings[keyof Drawings][]) drawing.dispose();
    this.drawings = this.create(this.capsules.length);
    this.planShown = null;
  }

  update(moment: Moment): void {
    this.drawBody(moment);
    this.drawNearest(moment);
    this.drawPlan(moment.shown);
    this.fadeGhosts(moment.pose);
  }

  /** The picture is about to be drawn by this camera. */
  seenBy(camera: PerspectiveCamera): void {
    this.drawings.ghosts.setAvatarDepth(-this.avatarAt.clone().applyMatrix4(camera.matrixWorldInverse).z);
  }

  placeLabels(camera: PerspectiveCamera, width: number, height: number): void {
    this.drawings.nearest.placeLabel(camera, width, height);
  }

  private radius(i: number): number {
    return this.capsules[i]?.radius ?? 0;
  }

  private drawBody({ pose, shown, markTouching, bodyIsAvatar }: Moment): void {
    const { body, solidBody, touching } = this.drawings;
    const fits = pose.capsules.length === 6 * this.capsules.length;
    const hits = new Set<number>();
    if (fits && (markTouching || shown.has("capsules"))) {
      this.capsules.forEach((capsule, i) => {
        if (capsuleTouches(this.boxes, pose.capsules, i, capsule.radius)) hits.add(i);
      });
    }
    this.touchingNames = [...hits].map((i) => this.capsules[i]?.name ?? "");
    const radius = (i: number) => this.radius(i);
    if (fits && bodyIsAvatar) solidBody.place(pose.capsules, radius);
    else solidBody.clear();
    if (fits && shown.has("capsules")) body.place(pose.capsules, radius, (i) => !hits.has(i));
    else body.clear();
    if (fits) touching.place(pose.capsules, (i) => this.radius(i) + 0.004, (i) => hits.has(i));
    else touching.clear();
  }

  private drawNearest({ pose, status, shown }: Moment): void {
    const { nearest } = this.drawings;
    const pair = shown.has("nearest") ? status?.nearest : null;
    const capsule = pair ? this.capsules.findIndex((c) => c.name === pair.capsule) : -1;
    const box = pair ? this.boxes[this.boxNames.indexOf(pair.obstacle)] : undefined;
    if (capsule < 0 || !box || box.hollow || pose.capsules.length !== 6 * this.capsules.length) nearest.hide();
    else nearest.show(box, pose.capsules, capsule, this.radius(capsule));
  }

  private drawPlan(shown: ReadonlySet<OverlayName>): void {
    const wanted = (["path", "ghosts", "goal"] as const).filter((name) => shown.has(name)).join();
    if (wanted === this.planShown) return;
    this.planShown = wanted;
    const { path, ghosts, goal, chosen } = this.drawings;
    const { plan } = this;
    const radius = (i: number) => this.radius(i % Math.max(1, this.capsules.length));
    path.show(plan && shown.has("path") ? plan.root : [], plan?.heights ?? []);
    ghosts.place(plan && shown.has("ghosts") ? plan.ghosts.slice(0, MOST_GHOSTS).flat() : [], radius);
    goal.place(plan && shown.has("goal") ? plan.goal : [], radius);
    chosen.place(plan && shown.has("goal") ? plan.chosen : [], radius);
  }

  /** Ghosts that stand where the avatar does now, and those far ahead, are weaker. */
  private fadeGhosts({ x, y, z }: ShownPose): void {
    const { plan } = this;
    this.avatarAt.set(x, y + BREAST, z);
    if (!plan || this.capsules.length === 0) return;
    const shares = plan.root.map(([gx, gz]) => ghostShare(Math.hypot(gx - x, gz - z)));
    this.drawings.ghosts.setShares((i) => shares[Math.floor(i / this.capsules.length)] ?? 0);
  }

  private create(count: number): Drawings {
    const p = this.palette();
    const drawings: Drawings = {
      body: new CapsuleSet(count, { color: p.capsule, opacity: 0.55, middle: 0.06 }),
      solidBody: new CapsuleSet(count, { solid: p.accent }),
      touching: new CapsuleSet(count, { color: p.touching, opacity: 0.72, middle: 1, onTop: true }),
      ghosts: new CapsuleSet(count * MOST_GHOSTS, { color: p.ghost, opacity: 0.34, middle: 0.25, ghost: true }),
      goal: new CapsuleSet(count, { color: p.goal, opacity: 0.5, middle: 0.03 }),
      chosen: new CapsuleSet(count, { color: p.chosen, opacity: 0.5, middle: 0.03 }),
      path: new PathRibbon(p.path),
      nearest: new NearestLine(p.nearest, this.label),
    };
    const { path, nearest, ...sets } = drawings;
    this.group.add(path.mesh, nearest.group, ...Object.values(sets).map((set) => set.group));
    return drawings;
  }
}
