/** Where the server listens, relative to the page. */

/** The address of the live session. */
export function sessionUrl(): string {
  const url = new URL("ws", document.baseURI);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  return url.href;
}

/** The address that takes avatar files. */
export const UPLOAD_URL = "api/avatars";
