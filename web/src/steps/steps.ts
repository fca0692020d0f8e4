/** What steps leave behind: a sound, a print on the ground. */

import type { SceneMessage } from "../generated/messages";
import type { ShownPose } from "../net/pose_timeline";
import type { Picture } from "../picture";
import { Footprints } from "./footprints";
import { StepSound, type GroundKind } from "./step_sound";
import { StepWatch } from "./step_watch";

export class Steps {
  /** Steps that came down since the page was opened. */
  count = 0;
  private readonly watch = new StepWatch();
  private readonly sound = new StepSound();
  private readonly prints: Footprints;
  private scene: SceneMessage | null = null;

  constructor(private readonly picture: Picture) {
    this.prints = new Footprints(picture.stage.palette.path);
    this.prints.mesh.visible = false;
    picture.stage.scene.add(this.prints.mesh);
  }

  get printed(): number {
    return this.prints.count;
  }

  /** Looks whether a foot has come down in the pose that is drawn. */
  update(pose: ShownPose, { heard, shown }: { readonly heard: boolean; readonly shown: boolean }): void {
    const { message } = this.picture.world;
    if (message !== this.scene) this.prints.clear();
    this.scene = message;
    this.prints.mesh.visible = shown && this.prints.count > 0;
    this.prints.paint(this.picture.stage.palette.path);
    const step = this.watch.update(pose);
    if (!step) return;
    this.count++;
    if (heard) this.sound.play(step.speed, groundAt(this.scene, pose.x, pose.z));
    for (const foot of shown ? step.feet : []) {
      const ankle = this.picture.avatar.ankle(foot);
      if (ankle) this.prints.add([ankle[0], pose.y, ankle[2]], pose.heading);
    }
  }
}

/** The floor of a scene is hard, the field round it soft. */
export function groundAt(scene: SceneMessage | null, x: number, z: number): GroundKind {
  if (!scene) return "hard";
  const { center, size } = scene.ground;
  return Math.abs(x - center[0]) <= size[0] / 2 && Math.abs(z - center[1]) <= size[1] / 2 ? "hard" : "soft";
}
