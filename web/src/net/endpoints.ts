/** Where the server listens, relative to the page. */

const STORE = "elbowroom.key";
const KEY = /^[0-9a-f]{32}$/;

/** The address of the live session, which begins in this scene, if the server has it at hand. */
export function sessionUrl(scene: string | null): string {
  const url = new URL("ws", document.baseURI);
  if (scene !== null) url.searchParams.set("scene", scene);
  url.searchParams.set("key", pageKey());
  url.searchParams.set("opening", OPENING);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  return url.href;
}

/** The address that takes an avatar or motion file of this name. */
export function uploadUrl(name: string): string {
  return `api/avatars?${new URLSearchParams({ name, key: pageKey() })}`;
}

/** The address that reads a recording of this name. */
export function runUrl(name: string): string {
  return `api/runs?${new URLSearchParams({ name, key: pageKey() })}`;
}

/** The address of the recording that the server was started with. */
export function shownRunUrl(): string {
  return "api/run";
}

/** The address that writes frames of this avatar as a file with this ending. */
export function motionUrl(avatar: string, format: string): string {
  return `api/motions?${new URLSearchParams({ avatar, format, key: pageKey() })}`;
}

/** The address that writes a run of this avatar as a page of its own. */
export function pageUrl(avatar: string): string {
  return `api/pages?${new URLSearchParams({ avatar, key: pageKey() })}`;
}

/** The address of the walk that is shown, as a recording. */
export function recordingUrl(): string {
  return `api/walk.elbow?${new URLSearchParams({ key: pageKey(), opening: OPENING })}`;
}

/** The address that takes a scene that was built. */
export function scenesUrl(): string {
  return `api/scenes?${new URLSearchParams({ key: pageKey() })}`;
}

/** The address of a scene's document. */
export function sceneDocumentUrl(name: string): string {
  return `api/scenes/${encodeURIComponent(name)}/document`;
}

/** The address where an avatar walks a scene unseen. */
export function walksUrl(avatar: string): string {
  return `api/walks?${new URLSearchParams({ avatar, key: pageKey() })}`;
}

let key = "";
/** Tells this page from its copies, which have its key: a tab that was duplicated. */
const OPENING = drawn16();

/** The secret by which the server knows which files are this tab's; it outlives a reload, not the tab. */
function pageKey(): string {
  key ||= keptKey() ?? newKey();
  return key;
}

function keptKey(): string | null {
  try {
    const kept = sessionStorage.getItem(STORE);
    return kept !== null && KEY.test(kept) ? kept : null;
  } catch {
    return null;
  }
}

function drawn16(): string {
  return [...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

function newKey(): string {
  const drawn = drawn16();
  try {
    sessionStorage.setItem(STORE, drawn);
  } catch {
    return drawn; // a browser that stores nothing: the key lives as long as the page
  }
  return drawn;
}
