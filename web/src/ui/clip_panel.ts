/** The motion clips in the menu: which one plays, what was recognised in it, and what planning keeps of it. */

import type { ClipChoice, ClipMessage, Configure, Settings } from "../generated/messages";
import { text } from "../texts/texts";
import { byId } from "./dom";

export class ClipPanel {
  private readonly section = byId("clips", HTMLElement);
  private readonly select = byId("clip", HTMLSelectElement);
  private readonly planned = byId("clip-planned", HTMLInputElement);
  private readonly facts = byId("clip-facts", HTMLElement);

  constructor(configure: (change: Omit<Configure, "type">) => void) {
    this.select.addEventListener("change", () => configure({ clip: this.select.value }));
    this.planned.addEventListener("change", () => configure({ clipAsPlanned: this.planned.checked }));
  }

  /** Adds clips that the list does not have yet; the section shows as soon as there is one. */
  add(clips: readonly ClipChoice[]): void {
    const known = new Set([...this.select.options].map((option) => option.value));
    for (const { id, title } of clips) if (!known.has(id)) this.select.add(new Option(title, id));
    this.section.hidden = this.select.options.length < 2;
  }

  showSettings({ clip, clipAsPlanned }: Settings): void {
    this.select.value = clip;
    this.planned.checked = clipAsPlanned;
    this.planned.disabled = clip === "";
    this.facts.hidden = clip === "";
  }

  /** What was recognised in the clip that plays. */
  show(clip: ClipMessage): void {
    this.add([clip]);
    this.facts.textContent = factsOf(clip);
  }
}

export function factsOf(clip: ClipMessage): string {
  const unit = clip.unit === "body" ? text("clip.unitByBody", clip.metres.toPrecision(3)) : text("clip.unit", clip.unit);
  const figure = clip.format === "BVH" ? text("clip.figure", clip.format, clip.up.toUpperCase(), unit) : clip.format;
  const length = text("clip.length", figure, clip.seconds.toFixed(1), Number(clip.fps.toFixed(2)));
  const walks = clip.speed > 0 ? text("clip.walks", clip.speed.toFixed(1)) : "";
  return length + walks + text("clip.kept", clip.trunkDegrees.toFixed(0), clip.armDegrees.toFixed(0));
}
