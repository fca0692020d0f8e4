/** The avatar as it stands in the world: takes poses, fades when the camera is close, blinks now and then. */

import { Group, Vector3, type Object3D } from "three";
import type { AvatarMessage } from "../generated/messages";
import type { ShownPose } from "../net/pose_timeline";
import type { Foot } from "../steps/step_watch";
import type { AvatarFile } from "./avatar_file";
import { Blinking } from "./blinking";
import { Surfaces } from "./surfaces";

export class AvatarView {
  /** Stands at the root: position on the ground, turned to the heading. */
  readonly group = new Group();
  private file: AvatarFile | null = null;
  private joints: (Object3D | undefined)[] = [];
  private hips: Object3D | undefined;
  private readonly feet = new Map<Foot, Object3D>();
  private surfaces: Surfaces | null = null;
  private rich = true;
  private epoch = -1;
  private blinking: Blinking | null = null;
  private dispose: ((file: AvatarFile) => void) | null = null;
  /** Revision of the avatar that is on show; -1 without one. */
  revision = -1;

  /** Replaces the avatar. Without a file nothing is drawn here (the capsules are shown instead). */
  show(message: AvatarMessage, file: AvatarFile | null, dispose: ((file: AvatarFile) => void) | null): void {
    if (this.file) this.dispose?.(this.file);
    this.group.clear();
    this.feet.clear();
    this.file = file;
    this.dispose = dispose;
    this.revision = message.revision;
    this.joints = message.bones.map((bone) => file?.nodes.get(bone.node));
    this.hips = this.joints[message.bones.findIndex((bone) => bone.name === "hips")];
    for (const foot of ["left", "right"] as const) {
      const joint = this.joints[message.bones.findIndex((bone) => bone.name === `${foot}Foot`)];
      if (joint) this.feet.set(foot, joint);
    }
    this.surfaces = file ? new Surfaces(file.scene, this.rich) : null;
    this.blinking = file?.vrm?.expressionManager ? new Blinking(file.vrm.expressionManager) : null;
    if (!file) return;
    const placed = new Group();
    placed.position.set(...message.placement.position);
    placed.rotation.y = message.placement.heading;
    placed.scale.setScalar(message.placement.scale);
    placed.add(file.scene);
    this.group.add(placed);
  }

  /** Shows nobody, and frees what the last avatar took. */
  clear(): void {
    if (this.file) this.dispose?.(this.file);
    this.file = null;
    this.group.clear();
    this.joints = [];
    this.feet.clear();
    this.surfaces = null;
    this.blinking = null;
    this.revision = -1;
  }

  get loaded(): boolean {
    return this.file !== null;
  }

  /** Sets the joints from a pose of this avatar. */
  pose(pose: ShownPose): void {
    this.group.position.set(pose.x, pose.y, pose.z);
    this.group.rotation.y = pose.heading;
    const { rotations } = pose;
    this.joints.forEach((joint, i) => joint?.quaternion.fromArray(rotations, 4 * i));
    this.hips?.position.set(pose.hipsX, pose.hipsY, pose.hipsZ);
    if (pose.epoch !== this.epoch) {
      this.epoch = pose.epoch;
      this.group.updateMatrixWorld(true);
      this.file?.vrm?.springBoneManager?.reset();
    }
  }

  /** Where an ankle is, metres in the world; null without that foot. */
  ankle(foot: Foot): readonly [number, number, number] | null {
    return this.feet.get(foot)?.getWorldPosition(new Vector3()).toArray() ?? null;
  }

  /** Moves hair and cloth, eyelids and materials by `dt` seconds. */
  update(dt: number, still: boolean): void {
    if (!still) this.blinking?.update(dt);
    this.file?.vrm?.update(dt);
  }

  /** 1 is solid; below, the avatar is see-through, and hidden at 0. */
  fade(opacity: number): void {
    this.group.visible = opacity > 0.02;
    this.surfaces?.fade(opacity);
  }

  /** Whether surfaces are physically based or cheap. */
  setRich(rich: boolean): void {
    this.rich = rich;
    this.surfaces?.setRich(rich);
  }
}
