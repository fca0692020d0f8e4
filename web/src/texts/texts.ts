/** What the page says, in the language that it speaks. */

import { chosenLanguage, type Language } from "./language";
import { TABLE, type TextName } from "./table";

export type { TextName } from "./table";

let language: Language = "en";

/** Chooses the language; once, before anything is said. */
export function speak(wishes: readonly (string | null)[]): Language {
  language = chosenLanguage(wishes);
  return language;
}

/** The language that the page speaks. */
export function spoken(): Language {
  return language;
}

/** The text of this name; `{0}`, `{1}` stand for the values. */
export function text(name: TextName, ...values: readonly (string | number)[]): string {
  return filled(TABLE[name][language], values);
}

/** A text with its values put in. */
export function filled(pattern: string, values: readonly (string | number)[]): string {
  return pattern.replace(/\{(\d)\}/g, (_, place: string) => String(values[Number(place)] ?? ""));
}
