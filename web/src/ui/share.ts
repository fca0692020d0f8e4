/** Hands the page's address to someone: by the system's own dialog on a phone, else into the clipboard. */

import { text } from "../texts/texts";

/** What became of it, in one sentence for the user; "" where the system's dialog says it. */
export async function shareAddress(title: string, url: string, ownAvatar: boolean): Promise<string> {
  const remark = ownAvatar ? text("share.own") : "";
  if (hasFingers() && "share" in navigator) {
    try {
      await navigator.share({ title, url });
      return "";
    } catch (error) {
      if (error instanceof DOMException && error.name === "AbortError") return "";
    }
  }
  try {
    await navigator.clipboard.writeText(url);
    return text("share.copied") + remark;
  } catch {
    return text("share.copy", url) + remark;
  }
}

/** Whether the system has a dialog that takes a file: that of a phone. */
export function canShareFile(file: File): boolean {
  return hasFingers() && (navigator.canShare?.({ files: [file] }) ?? false);
}

/** Hands a file to the system's own dialog, at the press of a button. */
export async function shareFile(file: File): Promise<void> {
  await navigator.share({ files: [file] }).catch((error: unknown) => {
    if (!(error instanceof DOMException && error.name === "AbortError")) throw error;
  });
}

function hasFingers(): boolean {
  return window.matchMedia("(pointer: coarse)").matches;
}
