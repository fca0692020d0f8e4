/** The second run in the picture: an avatar of its own, see-through beside the first or solid in its own half. */

import { Group } from "three";
import type { AvatarFile } from "../avatar/avatar_file";
import { AvatarView } from "../avatar/avatar_view";
import type { AvatarMessage } from "../generated/messages";
import type { ShownPose } from "../net/pose_timeline";
import { CapsuleSet } from "../overlays/capsule_set";

const GHOST = 0.38;

export class Companion {
  readonly group = new Group();
  private readonly view = new AvatarView();
  private capsules: CapsuleSet | null = null;
  private loads = 0;

  constructor(private readonly message: AvatarMessage, private readonly rich: boolean, private readonly color: number) {
    this.group.add(this.view.group);
  }

  /** Fetches the avatar's file; one without a file is shown by its collision body. @throws Error */
  async load(): Promise<void> {
    const { message } = this;
    if (message.url === null) {
      this.capsules = new CapsuleSet(message.capsules.length, { color: this.color, opacity: 0.5, middle: 0.2 });
      this.group.add(this.capsules.group);
      return;
    }
    const load = ++this.loads;
    const { loadAvatarFile, disposeAvatarFile } = await import("../avatar/avatar_file");
    const file: AvatarFile = await loadAvatarFile(new URL(message.url, document.baseURI).href);
    if (load !== this.loads) {
      disposeAvatarFile(file);
      return;
    }
    this.view.setRich(this.rich);
    this.view.show(message, file, disposeAvatarFile);
  }

  pose(pose: ShownPose, solid: boolean, dt: number): void {
    this.view.pose(pose);
    this.view.update(dt, true);
    this.view.fade(solid ? 1 : GHOST);
    const fits = pose.capsules.length === 6 * this.message.capsules.length;
    if (fits) this.capsules?.place(pose.capsules, (i) => this.message.capsules[i]?.radius ?? 0);
    else this.capsules?.clear();
  }

  dispose(): void {
    this.loads++;
    this.group.removeFromParent();
    this.view.clear();
    this.capsules?.dispose();
  }
}
