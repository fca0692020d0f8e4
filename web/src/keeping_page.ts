/** Asks the browser to keep this page, so that it loads once, and opens while its server is away. */

/** Where the browser can; it cannot where the address is neither of this machine nor encrypted. */
export async function keepPage(): Promise<void> {
  if (!("serviceWorker" in navigator) || !import.meta.env.PROD) return;
  try {
    await navigator.serviceWorker.register("./sw.js");
    const { active } = await navigator.serviceWorker.ready;
    const page = new URL("./", location.href).href;
    active?.postMessage([page, ...performance.getEntriesByType("resource").map(({ name }) => name)]);
  } catch (error) {
    console.info("The browser does not keep this page:", error);
  }
}
