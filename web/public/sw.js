/**
 * Keeps the page for when its server is away. The page itself is always asked of the server first, so an old one never
 * hides a new one; files that have their contents in their names come from here once they have been fetched.
 */

const KEPT = "elbowroom";
/** The server is asked whether what the browser has is still the newest. */
const ASKED_AGAIN = { cache: "no-cache" };
/** Over when the newest page is in place of the one before. */
let renewed = Promise.resolve();

self.addEventListener("install", () => self.skipWaiting());
self.addEventListener("activate", (event) => event.waitUntil(self.clients.claim()));
// What the first visit has fetched before this worker was there: addresses of this page's own files.
self.addEventListener("message", (event) => event.waitUntil(keepAll(event.data.filter(isKept))));

self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || !isKept(request.url)) return;
  event.respondWith(isLasting(request.url) ? kept(request) : fresh(event));
});

function isLasting(address) {
  return new URL(address).pathname.includes("/assets/");
}

/** The page, its scripts, icons and manifest; nothing that the server computes. */
function isKept(address) {
  const { origin, pathname } = new URL(address);
  return origin === location.origin && /(\/|\/index\.html|\/assets\/[^/]+|\/icon[^/]*|\.webmanifest)$/.test(pathname);
}

/** Addresses of one page differ in what is shown there only. */
function keyOf(address) {
  const { origin, pathname } = new URL(address);
  return origin + pathname;
}

async function kept(request) {
  const cache = await caches.open(KEPT);
  const found = await cache.match(keyOf(request.url));
  if (found) return found;
  const answer = await fetch(request);
  if (answer.ok) await cache.put(keyOf(request.url), answer.clone());
  return answer;
}

async function fresh(event) {
  const key = keyOf(event.request.url);
  try {
    const answer = await fetch(event.request.url, ASKED_AGAIN);
    if (answer.ok) event.waitUntil((renewed = renew(key, answer.clone(), renewed)));
    return answer;
  } catch (error) {
    const found = await (await caches.open(KEPT)).match(key);
    if (found) return found;
    throw error;
  }
}

/** Keeps a page in place of the one before, when those `earlier` are; with another page its files are others. */
async function renew(key, answer, earlier) {
  await earlier.catch(() => {});
  const cache = await caches.open(KEPT);
  const before = await cache.match(key);
  if (before && key.endsWith("/") && (await before.text()) !== (await answer.clone().text())) {
    for (const old of await cache.keys()) await cache.delete(old);
  }
  await cache.put(key, answer);
}

/** Waits for the newest page: what is kept of it is not what was kept of the one before. */
async function keepAll(addresses) {
  await renewed.catch(() => {});
  await Promise.all(addresses.map(keep));
}

async function keep(address) {
  const answer = await fetch(address, isLasting(address) ? {} : ASKED_AGAIN);
  if (answer.ok) await (await caches.open(KEPT)).put(keyOf(address), answer);
}
