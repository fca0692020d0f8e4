/** What an avatar's file says about itself, below its name in the menu. */

import type { AvatarMessage } from "../generated/messages";
import { inOwnWords, worded } from "../texts/worded";
import { text } from "../texts/texts";
import { byId, make } from "./dom";

/** Author and licence; when opened, what the file permits and what was made of it. */
export function showAvatarAbout({ authors, licence, facts }: AvatarMessage): void {
  const by = authors.length > 0 ? text("avatar.by", authors.join(", ")) : "";
  const summary = [by, licence].filter(Boolean).join(" · ") || worded("About this avatar");
  const about = byId("avatar-about", HTMLDetailsElement);
  about.replaceChildren(make("summary", {}, summary), make("ul", {}, ...facts.map((fact) => make("li", {}, inOwnWords(fact)))));
  about.hidden = facts.length === 0 && summary === worded("About this avatar");
}
