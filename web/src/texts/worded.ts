/** Puts the page's English, in index.html and in short phrases, into the language that the page speaks. */

import { PHRASES } from "./phrases";
import { spoken } from "./texts";

const ATTRIBUTES = ["title", "aria-label", "placeholder"] as const;

/** A phrase in the page's language; one that the table does not know stays English. */
export function worded(english: string): string {
  return spoken() === "en" ? english : (PHRASES[english] ?? english);
}

/** The server's notes in the page's language: sentences of parts, each of them a phrase. */
export function inOwnWords(notes: string): string {
  if (spoken() === "en") return notes;
  return notes.split("; ").map((note) => note.split(": ").map(worded).join("：")).join("；");
}

/** Words everything that stands in the document already. */
export function wordDocument(root: HTMLElement): void {
  root.lang = spoken();
  if (spoken() === "en") return;
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const english = node.nodeValue?.trim() ?? "";
    if (english) node.nodeValue = (node.nodeValue ?? "").replace(english, () => worded(english));
  }
  for (const element of root.querySelectorAll("*")) {
    for (const name of ATTRIBUTES) {
      const english = element.getAttribute(name);
      if (english) element.setAttribute(name, worded(english));
    }
  }
}
