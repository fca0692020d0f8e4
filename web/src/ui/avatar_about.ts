/** What an avatar's file says about itself, below its name in the menu. */

import type { AvatarMessage } from "../generated/messages";
import { inOwnWords, worded } from "../texts/worded";
import { text } from "../texts/texts";
import { byId, make } from "./dom";

/** Licences that files name by an address, as people call them. */
const NAMED: readonly (readonly [RegExp, string])[] = [
  [/^https:\/\/vrm\.dev\/licenses\/1\.0\/?$/, "VRM Public License 1.0"],
  [/^https?:\/\/creativecommons\.org\/publicdomain\/zero\/1\.0\/?/, "CC0 1.0"],
  [/^https?:\/\/creativecommons\.org\/licenses\/([a-z-]+)\/([\d.]+)\/?/, "CC $1 $2"],
];

/** What people call a licence; one that is not known stays as the file says it. */
export function licenceName(licence: string): string {
  const [pattern, name] = NAMED.find(([known]) => known.test(licence)) ?? [];
  return pattern && name ? licence.replace(pattern, name).replace(/^CC [a-z-]+/, (kind) => kind.toUpperCase()) : licence;
}

/** Author and licence; when opened, what the file permits and what was made of it. */
export function showAvatarAbout({ authors, licence, facts }: AvatarMessage): void {
  const by = authors.length > 0 ? text("avatar.by", authors.join(", ")) : "";
  const summary = [by, licenceName(licence)].filter(Boolean).join(" · ") || worded("About this avatar");
  const about = byId("avatar-about", HTMLDetailsElement);
  about.replaceChildren(make("summary", {}, summary), make("ul", {}, ...facts.map((fact) => make("li", {}, inOwnWords(fact)))));
  about.hidden = facts.length === 0 && summary === worded("About this avatar");
}
