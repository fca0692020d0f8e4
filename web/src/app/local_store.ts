/** The browser's own store, if it lets this page use it. */

export function localStore(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}
