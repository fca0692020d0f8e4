/** Keeps the keys that buttons name, "Pause (P)", true to what the keys do. */

import { capOf, DEFAULT_KEYS, type KeyMap } from "../input/key_map";

/** A single key in brackets at the end, in either kind of bracket. */
const NAMED = /([(（])(.)([)）])$/;

/** Writes the present keys into the titles of all buttons that do what a key does. */
export function showKeys(keys: KeyMap): void {
  for (const button of document.querySelectorAll<HTMLElement>("[data-action]")) {
    const deed = [...DEFAULT_KEYS.values()].find((one) => one === button.dataset["action"]);
    const code = deed && keys.codeOf(deed);
    if (!code) continue;
    if (button.title.length === 1) button.title = capOf(code);
    else button.title = button.title.replace(NAMED, (_, open: string, __, close: string) => `${open}${capOf(code)}${close}`);
  }
}
