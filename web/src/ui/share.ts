/** Hands the page's address to someone: by the system's own dialog on a phone, else into the clipboard. */

/** What became of it, in one sentence for the user; "" where the system's dialog says it. */
export async function shareAddress(title: string, url: string, ownAvatar: boolean): Promise<string> {
  const remark = ownAvatar ? " It names your own avatar too, for as long as this server keeps the file." : "";
  if (window.matchMedia("(pointer: coarse)").matches && "share" in navigator) {
    try {
      await navigator.share({ title, url });
      return "";
    } catch (error) {
      if (error instanceof DOMException && error.name === "AbortError") return "";
    }
  }
  try {
    await navigator.clipboard.writeText(url);
    return `The address is copied: it opens this scene, camera, planner and overlays.${remark}`;
  } catch {
    return `Copy this address to share what you see: ${url}${remark}`;
  }
}
