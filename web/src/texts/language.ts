/** The language of the page: as the address line says, else as was chosen before, else as the browser is set. */

export const LANGUAGES = ["en", "zh-Hant"] as const;
export type Language = (typeof LANGUAGES)[number];

/** The language for a tag such as "zh-TW" or "en-GB"; null for one that the page does not speak. */
export function languageOf(tag: string): Language | null {
  const [language] = tag.toLowerCase().split(/[-_]/);
  if (language === "en") return "en";
  return language === "zh" ? "zh-Hant" : null;
}

/** The first wish that the page can meet; English where there is none. */
export function chosenLanguage(wishes: readonly (string | null)[]): Language {
  for (const wish of wishes) {
    const found = wish === null ? null : languageOf(wish);
    if (found) return found;
  }
  return "en";
}
