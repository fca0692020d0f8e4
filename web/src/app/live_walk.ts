/** The live walk in the picture: its scene and avatar as the server told them last, shown again after a replay or building. */

import type { AvatarMessage, SceneMessage } from "../generated/messages";
import type { Picture } from "../picture";
import { NOTHING_LOOSE, type Loose } from "../stage/loose";
import { text } from "../texts/texts";
import type { Notices } from "../ui/notices";
import type { Veil } from "../ui/veil";
import { words } from "./words";
import { sceneTitle } from "../texts/scene_titles";

export interface LiveWalkParts {
  readonly picture: Picture;
  readonly veil: Veil;
  readonly notices: Notices;
}

export class LiveWalk {
  scene: SceneMessage | null = null;
  /** What was pushed in it. */
  loose: Loose = NOTHING_LOOSE;
  avatar: AvatarMessage | null = null;
  /** Of the avatar in the picture. */
  avatarTitle = "";

  constructor(private readonly parts: LiveWalkParts) {}

  /** The avatar is drawn by its collision body alone. */
  get bodyIsAvatar(): boolean {
    return this.avatar?.drawCapsules ?? false;
  }

  /** Shows the scene. */
  furnish(): void {
    const { scene } = this;
    const { picture, veil, notices } = this.parts;
    if (!scene) return;
    picture.showScene(scene, this.loose);
    if (scene.model) veil.download(true);
    picture
      .showModel()
      .catch((error: unknown) => notices.show("error", text("app.notShown", sceneTitle(scene.title), words(error))))
      .finally(() => scene.model && veil.download(false));
  }

  /** Shows the avatar. */
  dress(): void {
    const { avatar } = this;
    const { picture, veil, notices } = this.parts;
    if (!avatar) return;
    veil.download(true);
    picture
      .showAvatar(avatar)
      .then(() => (this.avatarTitle = avatar.title))
      .catch((error: unknown) => notices.show("error", text("app.notShown", avatar.title, words(error))))
      .finally(() => veil.download(false));
  }

  /** Shows both again after something else was in the picture. */
  showAgain(): void {
    this.furnish();
    if (this.parts.picture.shownAvatar !== this.avatar) this.dress();
  }
}
